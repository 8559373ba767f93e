//! Names of a text as symbols of figures.

/// Letters by their names.
const GREEK: [(&str, &str); 24] = [
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("epsilon", "ε"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("phi", "φ"),
    ("chi", "χ"),
    ("psi", "ψ"),
    ("omega", "ω"),
    ("Delta", "Δ"),
    ("Lambda", "Λ"),
    ("Phi", "Φ"),
    ("Omega", "Ω"),
];

/// A name as a symbol with markup: stars for italics, braces for scripts. What is behind the first `_`, and digits at the end, are below.
pub fn symbol(name: &str) -> String {
    let (letters, below) = match name.split_once('_') {
        Some((letters, below)) => (letters, below.replace('_', " ")),
        None => {
            let letters = name.trim_end_matches(|it: char| it.is_ascii_digit());
            (letters, name[letters.len()..].to_owned())
        }
    };
    let letter = GREEK.iter().find(|it| it.0 == letters).map_or(letters, |it| it.1);
    match below.is_empty() {
        true => format!("*{letter}*"),
        false => format!("*{letter}*_{{{below}}}"),
    }
}

//! Units of measurement: what they are made of, and their products and powers.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use capsulemap_models::quantity::Dimension;

/// Units that others are told by: a name, its size, and the powers of kg, m, s and A that it is made of.
const NAMED: [(&str, f64, [i8; 4]); 28] = [
    ("kg", 1.0, [1, 0, 0, 0]),
    ("m", 1.0, [0, 1, 0, 0]),
    ("s", 1.0, [0, 0, 1, 0]),
    ("A", 1.0, [0, 0, 0, 1]),
    ("g", 1e-3, [1, 0, 0, 0]),
    ("N", 1.0, [1, 1, -2, 0]),
    ("J", 1.0, [1, 2, -2, 0]),
    ("W", 1.0, [1, 2, -3, 0]),
    ("Pa", 1.0, [1, -1, -2, 0]),
    ("V", 1.0, [1, 2, -3, -1]),
    ("C", 1.0, [0, 0, 1, 1]),
    ("F", 1.0, [-1, -2, 4, 2]),
    ("H", 1.0, [1, 2, -2, -2]),
    ("Wb", 1.0, [1, 2, -2, -1]),
    ("T", 1.0, [1, 0, -2, -1]),
    ("ohm", 1.0, [1, 2, -3, -2]),
    ("rad", 1.0, [0, 0, 0, 0]),
    ("deg", PI / 180.0, [0, 0, 0, 0]),
    ("%", 1e-2, [0, 0, 0, 0]),
    ("Hz", 2.0 * PI, [0, 0, -1, 0]),
    ("rpm", PI / 30.0, [0, 0, -1, 0]),
    ("sec", 1.0, [0, 0, 1, 0]),
    ("min", 60.0, [0, 0, 1, 0]),
    ("h", 3600.0, [0, 0, 1, 0]),
    ("in", 0.0254, [0, 1, 0, 0]),
    ("bar", 1e5, [1, -1, -2, 0]),
    ("l", 1e-3, [0, 3, 0, 0]),
    ("L", 1e-3, [0, 3, 0, 0]),
];
/// The units of which the powers above are.
const BASE: [&str; 4] = ["kg", "m", "s", "A"];
/// What may stand before a unit, with the factor that it is.
const PREFIXES: [(char, f64); 9] = [
    ('p', 1e-12),
    ('n', 1e-9),
    ('u', 1e-6),
    ('µ', 1e-6),
    ('μ', 1e-6),
    ('m', 1e-3),
    ('c', 1e-2),
    ('k', 1e3),
    ('M', 1e6),
];
/// Sizes this near to each other are one.
const SAME: f64 = 1e-9;

/// A unit: powers of others, and its size in these.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// The powers that are not zero. What is no unit that is known is one of its own.
    powers: BTreeMap<String, f64>,
    /// The size; none where a number may be in it that turns one unit into another.
    size: Option<f64>,
}

impl Unit {
    /// The unit of plain numbers.
    pub fn one() -> Self {
        Unit { powers: BTreeMap::new(), size: Some(1.0) }
    }

    /// A unit as it is written: "N s/m", "kg/(m s)", "m/s^2", "1".
    pub fn of(written: &str) -> Self {
        let mut whole = Unit::one();
        let (mut is_below, mut brackets) = (false, 0);
        let mut word = String::new();
        for c in written.chars().chain([' ']) {
            match c {
                ' ' | '*' | '·' | '⋅' | '/' | '(' | ')' => {
                    if !word.is_empty() {
                        let sign = if is_below { -1.0 } else { 1.0 };
                        whole = whole.times(&Unit::word(&word).power(sign));
                        word.clear();
                        is_below &= brackets > 0;
                    }
                    match c {
                        '/' => is_below = true,
                        '(' => brackets += 1,
                        ')' => {
                            brackets -= 1;
                            is_below &= brackets > 0;
                        }
                        _ => {}
                    }
                }
                '²' => word.push('2'),
                '³' => word.push('3'),
                other => word.push(other),
            }
        }
        whole
    }

    /// A unit without products, with its power: "m", "s2", "s^-1".
    fn word(word: &str) -> Self {
        let ends = word.trim_end_matches(|c: char| c.is_ascii_digit() || "^-+".contains(c)).len();
        let (name, power) = word.split_at(ends);
        let power = power.trim_start_matches('^').parse().unwrap_or(1.0);
        if name.is_empty() {
            return Unit::one();
        }
        let named = |name: &str| NAMED.iter().find(|it| it.0 == name);
        let mut prefixed = PREFIXES.iter().filter_map(|(prefix, factor)| {
            named(name.strip_prefix(*prefix)?).map(|it| (factor * it.1, it.2))
        });
        let known = named(name).map(|it| (it.1, it.2)).or_else(|| prefixed.next());
        let unit = match known {
            Some((size, powers)) => {
                let powers = BASE.iter().zip(powers).filter(|it| it.1 != 0);
                let powers = powers.map(|(base, power)| ((*base).to_owned(), f64::from(power)));
                Unit { powers: powers.collect(), size: Some(size) }
            }
            None => Unit { powers: BTreeMap::from([(name.to_owned(), 1.0)]), size: Some(1.0) },
        };
        unit.power(power)
    }

    /// The product.
    pub fn times(&self, other: &Unit) -> Unit {
        let mut powers = self.powers.clone();
        for (base, power) in &other.powers {
            *powers.entry(base.clone()).or_insert(0.0) += power;
        }
        powers.retain(|_, power| *power != 0.0);
        Unit { powers, size: self.size.zip(other.size).map(|(a, b)| a * b) }
    }

    /// The quotient.
    pub fn over(&self, other: &Unit) -> Unit {
        self.times(&other.power(-1.0))
    }

    /// A power.
    pub fn power(&self, exponent: f64) -> Unit {
        let powers = self.powers.iter().map(|(base, power)| (base.clone(), power * exponent));
        let powers = powers.filter(|it| it.1 != 0.0).collect();
        Unit { powers, size: self.size.map(|it| libm::pow(it, exponent)) }
    }

    /// The same of a size that is not known.
    pub fn of_any_size(self) -> Unit {
        Unit { size: None, ..self }
    }

    /// Whether values in both may be added.
    pub fn fits(&self, other: &Unit) -> bool {
        let is_one_size = self.size.zip(other.size).is_none_or(|(a, b)| (a / b - 1.0).abs() < SAME);
        self.powers == other.powers && is_one_size
    }

    /// Whether it is that of plain numbers, of whatever size.
    pub fn is_number(&self) -> bool {
        self.powers.is_empty()
    }

    /// What a value in it is multiplied by to be in another unit; none where that is of another kind.
    pub fn ratio(&self, other: &Unit) -> Option<f64> {
        let ratio = self.size.zip(other.size).map(|(a, b)| a / b);
        ratio.filter(|_| self.powers == other.powers)
    }

    /// The unit of the same kind that is made of units of the SI.
    pub fn of_si(&self) -> Unit {
        Unit { size: Some(1.0), powers: self.powers.clone() }
    }

    /// Whether a name is that of a unit.
    pub fn is_known(name: &str) -> bool {
        let is_of_letters = name.chars().all(char::is_alphabetic);
        is_of_letters && Unit::of(name).unknown().next().is_none()
    }

    /// What it is made of that is no unit that is known.
    pub fn unknown(&self) -> impl Iterator<Item = &str> {
        let names = self.powers.keys().map(String::as_str);
        names.filter(|name| !BASE.contains(name))
    }

    /// Its size as a prefix of one of the units that it is made of, where it is one.
    fn prefix(&self) -> Option<(&str, char)> {
        let size = self.size?;
        self.powers.iter().filter(|it| it.0 != "kg").find_map(|(base, power)| {
            let is_it = |factor: f64| (libm::pow(factor, *power) / size - 1.0).abs() < SAME;
            let prefix = PREFIXES.iter().find(|it| is_it(it.1))?;
            Some((base.as_str(), prefix.0))
        })
    }

    /// How it is written in few words: as a unit that has a name, or with one of force, energy or power in it where that takes
    /// fewer powers than without.
    pub fn in_fewest(&self) -> String {
        let mut named = Dimension::ALL.into_iter().map(Dimension::unit);
        let is_it = |it: &&str| !it.contains("rad") && Unit::of(it).fits(self);
        if let Some(unit) = named.find(is_it) {
            return unit.to_owned();
        }
        let with = ["N", "J", "W"].into_iter().flat_map(|name| {
            [1.0, -1.0].map(|power| {
                let mut rest = self.over(&Unit::of(name).power(power));
                rest.powers.insert(name.to_owned(), power);
                rest
            })
        });
        let fewest = std::iter::once(self.clone()).chain(with);
        let fewest = fewest.min_by(|a, b| a.count().total_cmp(&b.count()));
        fewest.map_or_else(String::new, |it| it.written())
    }

    /// How many units are multiplied or divided by in it; with nothing above its line it takes more words than with one unit there.
    fn count(&self) -> f64 {
        let count: f64 = self.powers.values().map(|it| it.abs()).sum();
        let has_above = self.powers.values().any(|it| *it > 0.0);
        if has_above { count } else { count + 1.5 }
    }

    /// How it is written, with its size where that is not one.
    pub fn written(&self) -> String {
        let prefix = self.prefix();
        let part = |sign: f64| {
            let of_sign = self.powers.iter().filter(|it| it.1 * sign > 0.0);
            let words = of_sign.map(|(base, power)| {
                let prefixed = prefix.filter(|it| it.0 == base);
                let name = prefixed.map_or(base.clone(), |it| format!("{}{base}", it.1));
                match power.abs() {
                    1.0 => name,
                    power => format!("{name}{power}"),
                }
            });
            words.collect::<Vec<_>>()
        };
        let (above, below) = (part(1.0), part(-1.0));
        let above = if above.is_empty() { "1".to_owned() } else { above.join(" ") };
        let plain = match below.len() {
            0 => above,
            1 => format!("{above}/{}", below[0]),
            _ => format!("{above}/({})", below.join(" ")),
        };
        match self.size {
            Some(size) if prefix.is_none() && (size - 1.0).abs() >= SAME => {
                format!("{size} {plain}")
            }
            _ => plain,
        }
    }
}

//! How each quantity is named, in which unit figures show it, and its factor from SI.

use super::text::Text;
use super::ticks::{power_of_ten, short};
use crate::store::dataset::{Dataset, Values, Variable};

/// A quantity as figures show it.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// What it is, in words.
    name: Text,
    /// Its symbol, with markup; empty if it has none.
    symbol: String,
    /// The unit shown, with markup; empty if it has none.
    unit: String,
    /// Value shown per value stored.
    pub factor: f64,
    /// Whether it counts, so that only whole numbers make sense.
    pub whole: bool,
}

/// Stored name, words, symbol, unit shown, value shown per value in SI.
type Row = (&'static str, &'static str, &'static str, &'static str, f64);

/// The quantities that have a usual form; others are shown as they are stored.
const TABLE: &[Row] = &[
    ("omega", "Frequency", "*ω*", "rad/s", 1.0),
    ("p_d", "Force amplitude", "*p*_{d}", "N", 1.0),
    ("k1", "Stiffness", "*k*_{1}", "kN/m", 1e-3),
    ("k2", "Stiffness", "*k*_{2}", "kN/m", 1e-3),
    ("delta", "Gap", "*δ*", "mm", 1e3),
    ("m1", "Internal mass", "*m*_{1}", "kg", 1.0),
    ("m2", "Capsule mass", "*m*_{2}", "kg", 1.0),
    ("c", "Damping", "*c*", "N s/m", 1.0),
    ("mu_s", "Static friction", "*μ*_{s}", "", 1.0),
    ("mu_d", "Dynamic friction", "*μ*_{d}", "", 1.0),
    ("v_s", "Stribeck velocity", "*v*_{s}", "m/s", 1.0),
    ("g", "Gravity", "*g*", "m/s^{2}", 1.0),
    ("start_r", "Initial", "*x*_{1} − *x*_{2}", "mm", 1e3),
    ("start_y1", "Initial", "*y*_{1}", "m/s", 1.0),
    ("start_y2", "Initial", "*y*_{2}", "m/s", 1.0),
    ("phase", "Initial phase", "*φ*", "rad", 1.0),
    ("start_phase", "Initial phase", "*φ*", "rad", 1.0),
    ("section_phase", "Section phase", "*φ*_{s}", "rad", 1.0),
    ("time", "Time", "", "s", 1.0),
    ("section_r", "Stroboscopic", "*x*_{1} − *x*_{2}", "mm", 1e3),
    ("section_y1", "Stroboscopic", "*y*_{1}", "m/s", 1.0),
    ("section_y2", "Stroboscopic", "*y*_{2}", "m/s", 1.0),
    ("impact_phase", "Impact phase", "*ωt*", "rad", 1.0),
    ("impact_y1", "Impact velocity", "*y*_{1}", "m/s", 1.0),
    ("impact_y2", "Impact velocity", "*y*_{2}", "m/s", 1.0),
    ("history_r", "", "*x*_{1} − *x*_{2}", "mm", 1e3),
    ("history_x2", "", "*x*_{2}", "mm", 1e3),
    ("history_y1", "", "*y*_{1}", "m/s", 1.0),
    ("history_y2", "", "*y*_{2}", "m/s", 1.0),
    ("history_drive", "Drive", "*p*_{d} cos *ωt*", "N", 1.0),
    ("velocities", "", "*y*_{1}, *y*_{2}", "m/s", 1.0),
    ("relative_velocity", "", "*y*_{1} − *y*_{2}", "m/s", 1.0),
    ("outcome", "Outcome", "", "", 1.0),
    ("period", "Period", "", "", 1.0),
    ("progression_speed", "Progression speed", "", "mm/s", 1e3),
    ("progression_per_cycle", "Progression per cycle", "", "mm", 1e3),
    ("work_net", "Net work per cycle", "", "mJ", 1e3),
    ("work_positive", "Positive work per cycle", "", "mJ", 1e3),
    ("work_absolute", "Absolute work per cycle", "", "mJ", 1e3),
    ("work_actuator", "Actuator work per cycle", "", "mJ", 1e3),
    ("friction_loss", "Friction loss per cycle", "", "mJ", 1e3),
    ("damper_loss", "Damper loss per cycle", "", "mJ", 1e3),
    ("energy_residual", "Energy residual", "", "", 1.0),
    ("momentum_residual", "Momentum residual", "", "", 1.0),
    ("cost_of_transport", "Cost of transport", "", "", 1.0),
    ("impacts_per_cycle", "Impacts per cycle", "", "", 1.0),
    ("forward_slips_per_cycle", "Forward slips per cycle", "", "", 1.0),
    ("backward_slips_per_cycle", "Backward slips per cycle", "", "", 1.0),
    ("reversals_per_cycle", "Reversals per cycle", "", "", 1.0),
    ("stick_share", "Share of sticking", "", "", 1.0),
    ("peak_contact_force", "Peak contact force", "", "N", 1.0),
    ("grazing_margin", "Grazing margin", "", "mm", 1e3),
    ("lyapunov_exponent", "Lyapunov exponent", "", "1/s", 1.0),
    ("lyapunov_uncertainty", "Uncertainty of the exponent", "", "1/s", 1.0),
    ("largest_multiplier", "Largest multiplier", "", "", 1.0),
    ("integration_defect", "Integration defect", "", "", 1.0),
    ("excluded_period", "Longest period excluded", "", "", 1.0),
    ("section_residual", "Section residual", "", "", 1.0),
];

/// The row called `name`.
fn row(name: &str) -> Option<&'static Row> {
    TABLE.iter().find(|row| row.0 == name)
}

impl Quantity {
    /// The quantity called `name`, described by `dataset` where the table does not know it.
    pub fn named(name: &str, dataset: &Dataset) -> Quantity {
        let on_branches = || dataset.variable(&format!("branch_{name}"));
        let stored = dataset.variable(name).or_else(|| dataset.coordinate(name));
        let stored = stored.or_else(on_branches);
        let whole = stored.is_some_and(|it| matches!(it.values, Values::Integer(_)));
        match row(name) {
            Some((_, words, symbol, unit, factor)) => Quantity {
                name: Text::plain(words),
                symbol: symbol.to_string(),
                unit: unit.to_string(),
                factor: *factor,
                whole,
            },
            None => Quantity { whole, ..Quantity::as_stored(name, stored) },
        }
    }

    fn as_stored(name: &str, stored: Option<&Variable>) -> Quantity {
        let words = stored.map_or("", |variable| variable.long_name.as_str());
        let mut letters = if words.is_empty() { name } else { words }.chars();
        let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
        let unit = stored.map_or("1", |variable| variable.unit.as_str());
        Quantity {
            name: Text::plain(&(first + letters.as_str())),
            symbol: String::new(),
            unit: if unit == "1" { String::new() } else { raised(unit) },
            factor: 1.0,
            whole: false,
        }
    }

    /// The label with its unit in brackets, when `offset` is taken from the numbers and they count
    /// powers of ten. It may be broken at its spaces; symbols and units hold none that break.
    pub fn label(&self, offset: &str, exponent: i32) -> Text {
        let minus = match offset.strip_prefix('\u{2212}') {
            _ if offset.is_empty() => String::new(),
            Some(positive) => format!(" + {positive}"),
            None => format!(" − {offset}"),
        };
        let symbol = format!("{}{minus}", self.symbol);
        let unit = match (exponent, self.unit.as_str()) {
            (0, "") => String::new(),
            (0, unit) => format!("({unit})"),
            (_, "") => format!("({})", power_of_ten(exponent)),
            (_, unit) => format!("({} {unit})", power_of_ten(exponent)),
        };
        let parts = [symbol, unit].map(|part| Text::markup(&part.replace(' ', "\u{a0}")));
        parts.into_iter().fold(self.name.clone(), |label, part| {
            let joint = if label.is_empty() || part.is_empty() { "" } else { " " };
            label.then(Text::plain(joint)).then(part)
        })
    }

    /// The short form for legends: the symbol, or the words where there is none.
    pub fn short_name(&self) -> Text {
        if self.symbol.is_empty() { self.name.clone() } else { Text::markup(&self.symbol) }
    }

    /// "symbol = value unit", for a `value` in SI.
    pub fn note(&self, value: f64) -> Text {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let equals = format!(" = {}{unit}", short(value * self.factor));
        self.short_name().then(Text::markup(&equals))
    }
}

/// A unit as written in tables ("m/s^2"), with its powers raised.
fn raised(unit: &str) -> String {
    let mut markup = String::new();
    let mut characters = unit.chars().peekable();
    while let Some(character) = characters.next() {
        if character != '^' {
            markup.push(if character == '*' { '·' } else { character });
            continue;
        }
        markup.push_str("^{");
        while let Some(digit) = characters.next_if(|c| c.is_ascii_digit() || *c == '-') {
            markup.push(if digit == '-' { '−' } else { digit });
        }
        markup.push('}');
    }
    markup
}

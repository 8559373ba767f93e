//! How each quantity is named in figures, and its values in the unit that they show.

use std::rc::Rc;

use super::chosen::Chosen;
use super::scale::{Scale, Spacing, finite_range};
use super::text::Text;
use super::ticks::{power_of_ten, rounded, short};
use super::unit::{ShownUnit, raised};
use crate::store::catalogue::{self, Place, Shown};
use crate::store::dataset::{Dataset, Values};
use crate::study::ScaleChoice;
use crate::study::axis::range;
use crate::tradeoff::NOISE;

/// Ratio of positive values above which their logarithm is shown.
const MANY_DECADES: f64 = 1000.0;

/// What rounding leaves of a result that is zero, by the unit in which it is stored: the motions have some metres per
/// second, centimetres, joules and newtons, in which steps are exact to 1e-12.
fn rounding(unit: &str) -> f64 {
    match unit {
        "m/s" => NOISE,
        "m" | "J" => 1e-12,
        "N" => 1e-10,
        _ => 0.0,
    }
}

/// A quantity as figures show it.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// By what it is called in files and requests.
    pub key: String,
    /// Its name as text.
    name: Text,
    /// Its symbol, with markup; empty if it has none.
    symbol: String,
    /// The unit shown, with markup; empty if it has none.
    unit: String,
    /// Value shown per value stored.
    pub factor: f64,
    /// Whether it counts, so that only whole numbers make sense.
    pub whole: bool,
    /// What rounding leaves of a result, in the unit shown: less is nothing to see.
    pub noise: f64,
    /// Whether its logarithm is shown where it spans many decades: it is a ratio, and no speed, length or energy, whose
    /// differences matter.
    is_ratio: bool,
    /// Of an axis that is a path: what varies beside it, with markup; else empty.
    beside: String,
    /// What the request sets of it.
    pub chosen: Rc<Chosen>,
}

impl Quantity {
    /// The quantity called `name`, described by `dataset` where the catalogue has no form for it, and by its meaning where that does
    /// not hold it.
    pub fn named(name: &str, dataset: &Dataset) -> Quantity {
        let stored = dataset.variable(name).or_else(|| dataset.coordinate(name));
        let stored = stored.or_else(|| dataset.variable(&Place::Branch.name(name)));
        let whole = stored.is_some_and(|it| matches!(it.values, Values::Integer(_)));
        let is_result = dataset.coordinate(name).is_none();
        let unit = stored.map_or("", |it| it.unit.as_str());
        let least = if is_result { rounding(unit) } else { 0.0 };
        // Differences of coordinates matter, whatever their unit.
        let is_coordinate = dataset.model().points().any(|it| it.name == name);
        let is_ratio = is_result && unit == "1" && !is_coordinate;
        let described = catalogue::named(name, dataset.model());
        // A parameter of an oscillator that is a text has a symbol, and a meaning if that gives one.
        let meaning = described.map(|it| it.meaning).filter(|it| !it.ends_with(name));
        let meaning = meaning.filter(|_| dataset.model().parameter(name).is_some());
        match described.and_then(|entry| entry.shown) {
            Some(Shown { label, symbol, unit, factor }) => Quantity {
                key: name.to_owned(),
                name: match meaning.filter(|_| label.is_empty()) {
                    Some(meaning) => Text::plain(&capitalised(meaning)),
                    None => Text::plain(label),
                },
                symbol: symbol.to_string(),
                unit: unit.to_string(),
                factor,
                whole,
                noise: least * factor,
                is_ratio,
                beside: String::new(),
                chosen: Rc::default(),
            },
            None => {
                let words =
                    stored.map(|it| it.long_name.as_str()).or(described.map(|it| it.meaning));
                let unit = stored.map(|it| it.unit.as_str()).or(described.map(|it| it.unit));
                let called = Quantity::called(name, words.unwrap_or(name), unit.unwrap_or("1"));
                Quantity { whole, noise: least, is_ratio, ..called }
            }
        }
    }

    /// A quantity that no file of results holds, by its label with its unit, as "Time (s)".
    pub fn labelled(label: &str) -> Quantity {
        Quantity {
            key: label.to_owned(),
            name: Text::tex(label),
            symbol: String::new(),
            unit: String::new(),
            factor: 1.0,
            whole: false,
            noise: 0.0,
            is_ratio: false,
            beside: String::new(),
            chosen: Rc::default(),
        }
    }

    /// A quantity called by words, with a unit as files have it.
    fn called(key: &str, words: &str, unit: &str) -> Quantity {
        Quantity {
            key: key.to_owned(),
            name: Text::plain(&capitalised(if words.is_empty() { key } else { words })),
            symbol: String::new(),
            unit: if unit == "1" { String::new() } else { raised(unit) },
            factor: 1.0,
            whole: false,
            noise: 0.0,
            is_ratio: false,
            beside: String::new(),
            chosen: Rc::default(),
        }
    }

    /// The quantity as a request sets it.
    pub fn with(self, chosen: Rc<Chosen>) -> Quantity {
        let quantity = match chosen.unit().cloned() {
            None => self,
            Some(ShownUnit { unit, divisor, factor }) => Quantity {
                symbol: format!("{}{divisor}", self.symbol),
                unit,
                noise: self.noise / self.factor * factor,
                factor,
                ..self
            },
        };
        match chosen.label() {
            Some(label) => {
                let (name, symbol) = (Text::tex(label), String::new());
                Quantity { name, symbol, chosen: chosen.clone(), ..quantity }
            }
            None => Quantity { chosen, ..quantity },
        }
    }

    /// The quantity with words behind its name.
    pub fn followed_by(self, words: &str) -> Quantity {
        Quantity { name: self.name.then(Text::plain(words)), ..self }
    }

    /// The quantity with words before its name.
    pub fn preceded_by(self, words: &str) -> Quantity {
        let name = self.name.content();
        let mut letters = name.chars();
        let first: String = letters.next().into_iter().flat_map(char::to_lowercase).collect();
        let joint = if name.is_empty() { "" } else { " " };
        let name = Text::plain(&format!("{words}{joint}{first}{}", letters.as_str()));
        Quantity { name, ..self }
    }

    /// The scale of values of it, in the unit shown: logarithmic for positive ratios that span many decades, unless the
    /// request sets another.
    pub fn scale(&self, values: &[f64], margin: f64) -> Scale {
        let range = finite_range(values.iter().copied());
        let has_many_decades =
            range.is_some_and(|(low, high)| low > 0.0 && high / low > MANY_DECADES);
        let is_log = match self.chosen.scale() {
            None => self.is_ratio && has_many_decades,
            Some(chosen) => chosen == ScaleChoice::Log,
        };
        self.fitted(match is_log {
            true => Scale::log_around(values.iter().copied(), margin),
            false => Scale::above(self.noise, values.iter().copied(), margin),
        })
    }

    /// A scale in the unit shown, as the request sets it.
    pub fn fitted(&self, scale: Scale) -> Scale {
        let limits = self.limits();
        let [low, high] = limits.unwrap_or([scale.low, scale.high]);
        let scale = Scale { low, high, ..scale };
        match self.chosen.scale() {
            // A range that the figure chose to be logarithmic may be set to begin elsewhere.
            None if scale.spacing == Spacing::Log && low <= 0.0 => {
                Scale { spacing: Spacing::Linear, ..scale }
            }
            None => scale,
            Some(ScaleChoice::Linear) => Scale { spacing: Spacing::Linear, ..scale },
            Some(ScaleChoice::Symlog(width)) => scale.symmetric(width.map(|it| it * self.factor)),
            Some(ScaleChoice::Log) if low > 0.0 => Scale { spacing: Spacing::Log, ..scale },
            Some(ScaleChoice::Log) => {
                self.chosen.refuse("its axis is not above zero and cannot be logarithmic");
                scale
            }
        }
    }

    /// Whether a value, in the unit shown, lies within the limits that are set, if any are.
    pub fn is_within(&self, value: f64) -> bool {
        self.limits().is_none_or(|[low, high]| (low..=high).contains(&value))
    }

    /// The limits that are set, in the unit shown.
    pub fn limits(&self) -> Option<[f64; 2]> {
        self.chosen.limits().map(|limits| limits.map(|end| end * self.factor))
    }

    /// Notes how many of `values` have no place on a scale.
    pub fn note_left_out(&self, scale: &Scale, values: &[f64]) {
        let without_place = values.iter().filter(|it| it.is_finite() && !scale.can_hold(**it));
        self.chosen.leave_out(without_place.count());
    }

    /// Digits after the point of the numbers along its axis, if they are set.
    pub fn decimals(&self) -> Option<usize> {
        self.chosen.decimals()
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
        let label = parts.into_iter().fold(self.name.clone(), |label, part| {
            let joint = if label.is_empty() || part.is_empty() { "" } else { " " };
            label.then(Text::plain(joint)).then(part)
        });
        let joint = if self.beside.is_empty() { "" } else { "; " };
        label.then(Text::plain(joint)).then(Text::markup(&self.beside))
    }

    /// The quantity of an axis with what varies beside it, with markup.
    pub fn going_with(self, beside: String) -> Quantity {
        Quantity { beside, ..self }
    }

    /// How it goes along a path with these values (SI), with markup: from the first to the last, or between the least and the
    /// greatest where it turns back; nothing without values.
    pub fn course(&self, values: &[f64]) -> Option<String> {
        let (first, last) = (*values.first()?, *values.last()?);
        let [least, greatest] = range(values);
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let [first, last, least, greatest] =
            [first, last, least, greatest].map(|value| short(value * self.factor));
        let sign = self.sign();
        let told = match () {
            () if least == greatest => format!("{sign} = {first}{unit}"),
            () if is_monotone_or_stands(values) => format!("{sign} from {first} to {last}{unit}"),
            () => format!("{sign} between {least} and {greatest}{unit}"),
        };
        Some(told.replace(' ', "\u{a0}"))
    }

    /// Its name and unit in plain letters.
    pub fn told(&self) -> String {
        self.label("", 0).content().replace('\u{a0}', " ")
    }

    /// The short form for legends: the symbol, or the name where there is none.
    pub fn short_name(&self) -> Text {
        if self.symbol.is_empty() { self.name.clone() } else { Text::markup(&self.symbol) }
    }

    /// Its symbol with markup, or what it is called in files where there is none.
    pub fn sign(&self) -> &str {
        if self.symbol.is_empty() { &self.key } else { &self.symbol }
    }

    /// Its name alone, without symbol and unit.
    pub fn name(&self) -> &Text {
        &self.name
    }

    /// The unit shown; empty where there is none.
    pub fn unit(&self) -> Text {
        Text::markup(&self.unit)
    }

    /// A `value` in SI as a table shows it, without its unit.
    pub fn rounded(&self, value: f64) -> Text {
        Text::markup(&rounded(value * self.factor))
    }

    /// "symbol = value unit", for a `value` in SI, in one line.
    pub fn note(&self, value: f64) -> Text {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let equals = format!(" = {}{unit}", short(value * self.factor)).replace(' ', "\u{a0}");
        self.short_name().then(Text::markup(&equals))
    }
}

/// Words with a capital at their head.
fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    first + letters.as_str()
}

/// Whether values never fall, or never rise.
fn is_monotone_or_stands(values: &[f64]) -> bool {
    let pairs = || values.windows(2);
    pairs().all(|pair| pair[0] <= pair[1]) || pairs().all(|pair| pair[0] >= pair[1])
}

#[cfg(test)]
mod tests {
    use ndarray::{ArrayD, IxDyn};

    use super::*;
    use crate::figure::scale::Spacing;
    use crate::store::Variable;

    fn quantity(unit: &str) -> Quantity {
        let mut dataset = Dataset::default();
        let none = Values::Real(ArrayD::zeros(IxDyn(&[0])));
        let labels = [unit, "a result"].map(str::to_owned);
        dataset.variables.insert("result".into(), Variable::labelled(Vec::new(), labels, none));
        Quantity::named("result", &dataset)
    }

    #[test]
    fn rounding_fills_no_axis() {
        let speed = quantity("m/s");
        for values in [[-3e-15, 2e-15], [0.0, 9e-11], [1e-15, 1e-11]] {
            let scale = speed.scale(&values, 0.06);
            assert!(scale.low <= -0.1 && scale.high >= 0.1, "{values:?}: {scale:?}");
        }
        // A motion that differs by rounding alone is one value.
        let scale = speed.scale(&[0.01, 0.01 + 5e-11], 0.06);
        assert!(scale.high - scale.low > 1e-3, "{scale:?}");
        let scale = speed.scale(&[0.01, 0.01 + 1e-8], 0.06);
        assert!(scale.high - scale.low < 2e-8, "{scale:?}");
    }

    #[test]
    fn only_ratios_become_logarithmic_by_themselves() {
        let values = [1e-3, 0.1, 50.0];
        for (unit, spacing) in
            [("m/s", Spacing::Linear), ("J", Spacing::Linear), ("1", Spacing::Log)]
        {
            assert_eq!(quantity(unit).scale(&values, 0.06).spacing, spacing, "{unit}");
        }
    }
}

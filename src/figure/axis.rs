//! An axis of a panel: its scale, its label and as many numbers as there is room for.

use super::quantity::Quantity;
use super::scale::{Scale, Spacing};
use super::style::{LABEL_SIZE, LINE_HEIGHT, SMALL_SIZE};
use super::text::Text;
use super::ticks::{DIGITS, Tick, Ticks, linear_ticks, log_ticks, symmetric_ticks};

/// The direction an axis runs in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// Along the width of the page.
    Across,
    /// Along its height.
    Up,
}

/// What an axis is to show.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisRequest {
    /// What is measured along it.
    pub quantity: Quantity,
    /// The values shown, in the units of the figure.
    pub scale: Scale,
    /// Whether there are values to show at all.
    pub empty: bool,
    /// Whether it carries a label.
    pub labelled: bool,
    /// Whether its marks carry numbers.
    pub numbered: bool,
    /// What stands along it in place of numbers, as markup from 0 on; nothing where it has numbers.
    pub words: Vec<String>,
}

impl AxisRequest {
    /// An axis with label and numbers, over this range unless another is set.
    pub fn new(quantity: Quantity, scale: Scale) -> AxisRequest {
        let scale = quantity.fitted(scale);
        let words = Vec::new();
        AxisRequest { quantity, scale, empty: false, labelled: true, numbered: true, words }
    }

    /// An axis without a label along which these words, as markup, stand at 0, 1 and so on, the first at its upper end.
    pub fn of_words(words: Vec<String>) -> AxisRequest {
        // Both ends are half a step beyond the outermost words.
        let scale = Scale::over(words.len() as f64 - 0.5, -0.5);
        AxisRequest { words, labelled: false, ..AxisRequest::new(Quantity::labelled(""), scale) }
    }

    /// An axis around `values`, without marks where none of them is finite.
    pub fn around(quantity: Quantity, values: &[f64], margin: f64) -> AxisRequest {
        let scale = quantity.scale(values, margin);
        let empty = !values.iter().any(|value| value.is_finite() && scale.can_hold(*value));
        quantity.note_left_out(&scale, values);
        AxisRequest { empty, numbered: !empty, ..AxisRequest::new(quantity, scale) }
    }
}

/// An axis with its marks.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// From values to places.
    pub scale: Scale,
    /// What it shows, with its unit.
    pub name: String,
    /// Marks and numbers.
    pub ticks: Ticks,
    /// The lines of the label; none without one.
    pub label: Vec<Text>,
    /// Whether there are no values to show.
    pub empty: bool,
    /// Width of the widest number [pt].
    pub widest: f64,
    /// Whether its marks carry numbers.
    pub numbered: bool,
}

impl Axis {
    /// The axis of `request` over `length` [pt].
    pub fn new(request: &AxisRequest, along: Along, length: f64) -> Axis {
        let ticks = match request.empty {
            true => Ticks::default(),
            false if !request.words.is_empty() => ticks_of_words(&request.words),
            false => choose(request, along, length),
        };
        let widest = ticks.major.iter().map(|tick| label_width(&tick.label)).fold(0.0, f64::max);
        let room = length + 6.0;
        let label = match request.labelled {
            true => request.quantity.label(&ticks.offset, ticks.exponent),
            false => Text::default(),
        };
        let label = label.wrapped(room, LABEL_SIZE);
        Axis {
            scale: request.scale,
            name: request.quantity.told(),
            ticks,
            label,
            empty: request.empty,
            widest,
            numbered: request.numbered,
        }
    }

    /// Room that the lines of the label take [pt].
    pub fn label_room(&self) -> f64 {
        self.label.len() as f64 * LINE_HEIGHT * LABEL_SIZE
    }
}

/// Marks with words, one after another.
fn ticks_of_words(words: &[String]) -> Ticks {
    let marks = words.iter().enumerate();
    let marks = marks.map(|(place, words)| Tick { value: place as f64, label: words.clone() });
    Ticks { major: marks.collect(), ..Ticks::default() }
}

/// A logarithmic axis that spans less has no two powers of ten.
const A_DECADE: f64 = 10.0;

/// The densest marks whose numbers do not touch; two at least, where the range has them.
fn choose(request: &AxisRequest, along: Along, length: f64) -> Ticks {
    let candidates = candidates(request);
    let usual = if along == Along::Across { 9 } else { 7 };
    let mut roomy = candidates
        .iter()
        .filter(|it| it.major.len() <= usual + MORE && has_room(it, &request.scale, along, length));
    // Where steps of a size that is usual leave few numbers, smaller ones give a few more than usual.
    let chosen = roomy.clone().find(|it| it.major.len() <= usual);
    let chosen = chosen.filter(|it| it.major.len() >= FEW).or_else(|| roomy.next());
    match chosen {
        Some(ticks) if ticks.major.len() >= 2 => ticks.clone(),
        // Rather two numbers close together than an axis that cannot be read.
        _ => {
            let two = candidates.iter().rev().find(|ticks| ticks.major.len() >= 2);
            two.or(candidates.first()).cloned().unwrap_or_default()
        }
    }
}

/// Marks by the sizes of their steps, the densest first.
fn candidates(request: &AxisRequest) -> Vec<Ticks> {
    let scale = &request.scale;
    let decimals = request.quantity.decimals();
    let steps = DIGITS.map(|digits| (digits, 1)).into_iter();
    let steps = steps.chain((2..=40).map(|every| (DIGITS[DIGITS.len() - 1], every)));
    match scale.spacing {
        // Less than a decade has its marks where a linear axis has them.
        Spacing::Log if scale.high >= A_DECADE * scale.low => {
            steps.map(|(digits, every)| log_ticks(scale, digits, every)).collect()
        }
        Spacing::Symmetric(width) => {
            steps.map(|(digits, every)| symmetric_ticks(scale, width, digits, every)).collect()
        }
        Spacing::Linear | Spacing::Log => {
            let start = ((scale.high - scale.low).log10().floor() as i32) - 2;
            let start = if request.quantity.whole { start.max(0) } else { start };
            let steps = (start..start + 5).flat_map(|power| [1, 2, 5].map(|digit| (digit, power)));
            let mut candidates: Vec<Ticks> = steps
                .filter_map(|(digit, power)| linear_ticks(scale, digit, power, decimals))
                .collect();
            if request.quantity.whole {
                for ticks in &mut candidates {
                    ticks.minor.retain(|value| (value - value.round()).abs() < 1e-6);
                }
            }
            candidates
        }
    }
}

/// Fewer numbers leave values between them hard to read.
const FEW: usize = 4;
/// So many more numbers than usual are better than few.
const MORE: usize = 2;

/// Whether the numbers stand clear of each other.
fn has_room(ticks: &Ticks, scale: &Scale, along: Along, length: f64) -> bool {
    ticks.major.windows(2).all(|pair| {
        let distance = (scale.share(pair[1].value) - scale.share(pair[0].value)) * length;
        distance >= clearance(&pair[0].label, along) + clearance(&pair[1].label, along)
    })
}

/// How far other numbers stay from the middle of a number [pt].
fn clearance(label: &str, along: Along) -> f64 {
    match along {
        Along::Across => label_width(label) / 2.0 + 5.0,
        Along::Up => SMALL_SIZE * 0.8,
    }
}

fn label_width(label: &str) -> f64 {
    Text::markup(label).width(SMALL_SIZE)
}

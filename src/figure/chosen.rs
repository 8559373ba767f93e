//! What a request sets of a quantity, and what of it a figure has taken account of.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;

use super::unit::ShownUnit;
use crate::store::catalogue::{ATTRACTOR, DIRECTION, Entry, OUTCOME, PERIOD};
use crate::study::{Colouring, QuantitySettings, ScaleChoice, Setting};

/// Quantities whose values are kinds, each with its colour.
const KINDS: [Entry; 4] = [OUTCOME, PERIOD, ATTRACTOR, DIRECTION];

/// What is set of a quantity.
#[derive(Debug, Default, PartialEq)]
pub struct Chosen {
    set: QuantitySettings,
    unit: Option<ShownUnit>,
    used: RefCell<BTreeSet<Setting>>,
    without_place: Cell<usize>,
    fault: RefCell<Option<String>>,
}

impl Chosen {
    /// What `set` says, with the unit that it names.
    pub fn new(set: QuantitySettings, unit: Option<ShownUnit>) -> Chosen {
        Chosen { set, unit, ..Chosen::default() }
    }

    fn used(&self, setting: Setting) -> &QuantitySettings {
        self.used.borrow_mut().insert(setting);
        &self.set
    }

    /// The ends of its axis, or of its colours (SI).
    pub fn limits(&self) -> Option<[f64; 2]> {
        self.used(Setting::Limits).limits
    }

    /// How its values are spread.
    pub fn scale(&self) -> Option<ScaleChoice> {
        self.used(Setting::Scale).scale
    }

    /// The unit in which it is shown.
    pub fn unit(&self) -> Option<&ShownUnit> {
        self.used(Setting::Unit);
        self.unit.as_ref()
    }

    /// What it is called.
    pub fn label(&self) -> Option<&str> {
        self.used(Setting::Label).label.as_deref()
    }

    /// Digits after the point along its axis.
    pub fn decimals(&self) -> Option<usize> {
        self.used(Setting::Decimals).decimals
    }

    /// The colours of its values.
    pub fn colour_map(&self) -> Option<Colouring> {
        self.used(Setting::ColourMap).colour_map
    }

    /// The value in the middle of its colours (SI).
    pub fn centre(&self) -> Option<f64> {
        self.used(Setting::Centre).centre
    }

    /// The values at which a map has contour lines (SI).
    pub fn contours(&self) -> &[f64] {
        &self.used(Setting::Contours).contours
    }

    /// Notes that so many values have no place on its logarithmic scale.
    pub fn leave_out(&self, count: usize) {
        self.without_place.set(self.without_place.get() + count);
    }

    /// Notes that what is set does not fit.
    pub fn refuse(&self, why: &str) {
        self.fault.borrow_mut().get_or_insert_with(|| why.to_owned());
    }

    /// What does not fit.
    pub fn fault(&self) -> Option<String> {
        self.fault.borrow().clone()
    }

    /// Whether a setting is set and has no effect.
    fn is_unused(&self, setting: Setting) -> bool {
        let is_set = self.set.parts(setting, |value| value.to_string()).is_some();
        is_set && !self.used.borrow().contains(&setting)
    }

    /// What of it has no effect in the figure or leaves values out, a sentence each, for the quantity called `name`.
    pub fn notes(&self, name: &str) -> Vec<String> {
        let unused = Setting::NAMES.into_iter().filter(|(_, setting)| self.is_unused(*setting));
        let reason = match KINDS.iter().any(|kind| kind.name == name) {
            true => ": kinds have fixed colours, and those that occur are shown",
            false => "",
        };
        let unused = unused.map(|(key, _)| format!("`{key}` of {name} has no effect here{reason}"));
        let count = self.without_place.get();
        let left_out = (count > 0).then(|| {
            format!("{count} values of {name} are not above zero and have no place on its logarithmic scale")
        });
        unused.chain(left_out).collect()
    }
}

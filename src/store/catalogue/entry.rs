//! What the catalogue holds of a variable, and the form in which it is written down.

use crate::quantity::{Quantity, Shown};

/// Each integer of a category with its name.
pub type Flags = Vec<(i64, String)>;

/// A variable or a coordinate of a file of results.
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    /// Its name in files.
    pub name: &'static str,
    /// Its unit (SI); "1" where it has none, and empty where it is that of an axis of the file.
    pub unit: &'static str,
    /// What it is, in a phrase: its long name in files.
    pub meaning: &'static str,
    /// Of what it has a number.
    pub extent: Extent,
    /// What sort of numbers it has.
    pub numbers: Type,
    /// How figures show it; none where they show it as it is stored, called by its meaning.
    pub shown: Option<Shown>,
}

/// Of what a variable has a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// An axis of the study, or a constant where no axis varies it.
    Study,
    /// A dimension of its own, which is no axis of the study.
    Dimension,
    /// The study as a whole, once.
    Once,
    /// Each case.
    Case,
    /// Each case, several along this dimension.
    CaseRow(&'static str),
    /// Each place along this dimension.
    Table(&'static str),
    /// Each place along the first dimension, several along the second.
    TableRow(&'static str, &'static str),
    /// Each case of a block; no file of results has it.
    Block,
    /// Nothing that is stored: figures derive it from other variables.
    Derived,
}

/// A sort of numbers.
#[derive(Debug, Clone, Copy)]
pub enum Type {
    /// Measured quantities.
    Real,
    /// Counts and numbers of others.
    Whole,
    /// Categories with these names.
    Category(fn() -> Flags),
    /// Categories whose names depend on the file.
    CategoryOfFile,
}

impl Entry {
    /// Real numbers of a quantity that a model describes.
    pub(super) const fn of(quantity: Quantity, extent: Extent) -> Entry {
        let Quantity { name, dimension, meaning, shown } = quantity;
        Entry { name, unit: dimension.unit(), meaning, extent, numbers: Type::Real, shown }
    }

    /// The dimensions along which it lies, the axes of the study apart.
    pub fn dimensions(&self) -> Vec<&'static str> {
        match self.extent {
            Extent::Dimension => vec![self.name],
            Extent::CaseRow(row) | Extent::Table(row) => vec![row],
            Extent::TableRow(table, row) => vec![table, row],
            Extent::Study | Extent::Once | Extent::Case | Extent::Block | Extent::Derived => {
                Vec::new()
            }
        }
    }

    /// The names of a category; none where it is no category or where they depend on the file.
    pub fn flags(&self) -> Flags {
        match self.numbers {
            Type::Category(flags) => flags(),
            Type::Real | Type::Whole | Type::CategoryOfFile => Flags::new(),
        }
    }
}

/// Entries as constants, and all of them as `FIXED`: constant, name, unit, extent, sort of numbers and shown
/// form in a first line, the meaning in a second.
macro_rules! entries {
    ($($constant:ident $name:literal $unit:literal $extent:expr, $numbers:expr, $shown:expr,
        $meaning:literal;)*) => {
        $(
            #[doc = concat!("`", $name, "`: ", $meaning, ".")]
            pub const $constant: Entry = Entry {
                name: $name,
                unit: $unit,
                meaning: $meaning,
                extent: $extent,
                numbers: $numbers,
                shown: $shown,
            };
        )*
        /// Every entry of this file, in its order.
        pub(super) const FIXED: &[Entry] = &[$($constant,)*];
    };
}

pub(super) use entries;

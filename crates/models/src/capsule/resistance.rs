//! The laws of resistance to the capsule, and how friction switches, by name.

use super::parameter::Parameter;

/// The law of resistance to the capsule's motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Resistance {
    /// `mu_d (1 + exp(-|y2|/v_s)) N` against the motion, so 2 mu_d N where sliding begins; the paper's law.
    #[default]
    CoulombStribeck,
    /// `mu_d N` against the motion, at any speed.
    Coulomb,
    /// `c1 y2 + c2 |y2| y2` against the motion; nothing sticks in a medium (paper, Fig 1b).
    Medium,
}

impl Resistance {
    /// Every law by its name in studies, files and on the command line, in the order of declaration.
    pub const NAMES: [(&str, Resistance); 3] = [
        ("coulomb-stribeck", Resistance::CoulombStribeck),
        ("coulomb", Resistance::Coulomb),
        ("medium", Resistance::Medium),
    ];

    /// Their names.
    pub const OPTIONS: [&'static str; 3] =
        [Resistance::NAMES[0].0, Resistance::NAMES[1].0, Resistance::NAMES[2].0];

    /// Its name.
    pub fn name(self) -> &'static str {
        Resistance::NAMES[self as usize].0
    }

    /// How many times mu_d N the friction is where sliding begins, f_d(0+).
    pub fn onset_factor(self) -> f64 {
        match self {
            Resistance::CoulombStribeck => 2.0,
            Resistance::Coulomb => 1.0,
            Resistance::Medium => 0.0,
        }
    }

    /// The friction coefficient where sliding begins, in words.
    pub fn onset_in_words(self) -> String {
        let coefficient = Parameter::MuD.symbol();
        match self {
            Resistance::CoulombStribeck => format!("2 {coefficient}"),
            Resistance::Coulomb => coefficient.to_owned(),
            Resistance::Medium => "0".to_owned(),
        }
    }
}

/// How the friction switches between sticking and slipping.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Switching {
    /// Friction is set-valued at rest: the capsule slips until it stops, and rests until broken away.
    #[default]
    Filippov,
    /// Eq. (1) of the paper to the letter: the capsule freezes while |F| <= f_s, even at speed.
    AsPrinted,
}

impl Switching {
    /// Every reading by its name in studies, files and on the command line, in the order of declaration.
    pub const NAMES: [(&str, Switching); 2] =
        [("filippov", Switching::Filippov), ("as-printed", Switching::AsPrinted)];

    /// Their names.
    pub const OPTIONS: [&'static str; 2] = [Switching::NAMES[0].0, Switching::NAMES[1].0];

    /// Its name.
    pub fn name(self) -> &'static str {
        Switching::NAMES[self as usize].0
    }

    /// The reading with a name.
    pub fn named(name: &str) -> Option<Switching> {
        Switching::NAMES.iter().find(|it| it.0 == name).map(|it| it.1)
    }

    /// Whether the friction at rest balances the other forces, up to the force that breaks the capsule away.
    pub fn balances_at_rest(self) -> bool {
        self == Switching::Filippov
    }
}

//! The functions that a text may have, in numbers of any kind.

use capsulemap_engine::in_lanes;
use capsulemap_engine::lane::{Lane, elementary};

/// A function of one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Function {
    /// Square root.
    Sqrt,
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Log,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Hyperbolic tangent.
    Tanh,
    /// Magnitude, of constants.
    Abs,
}

impl Function {
    /// All by the names that texts have for them.
    pub const NAMES: [(&'static str, Function); 7] = [
        ("sqrt", Function::Sqrt),
        ("exp", Function::Exp),
        ("log", Function::Log),
        ("sin", Function::Sin),
        ("cos", Function::Cos),
        ("tanh", Function::Tanh),
        ("abs", Function::Abs),
    ];

    /// Its value, as every lane has it.
    pub fn value(self, x: f64) -> f64 {
        elementary_of(self, x)[0]
    }
}

in_lanes! {
    /// A function of a number, and what its series needs beside it: of a sine the cosine, of the hyperbolic tangent one less its square.
    ///
    /// Method: the hyperbolic tangent by an exponential that does not overflow. Each function of the lanes stands once, as it is long.
    pub fn elementary_of<L: Lane>(function: Function, x: L) -> [L; 2] {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        match function {
            Function::Sqrt => [x.sqrt(), zero],
            Function::Abs => [x.abs(), zero],
            Function::Log => [elementary::log(x), zero],
            Function::Sin | Function::Cos => {
                let (sin, cos) = elementary::sin_cos(x);
                if function == Function::Sin { [sin, cos] } else { [cos, sin] }
            }
            Function::Exp | Function::Tanh => {
                let is_tanh = function == Function::Tanh;
                let exponential = elementary::exp(if is_tanh { -(x.abs() + x.abs()) } else { x });
                if !is_tanh {
                    return [exponential, zero];
                }
                let size = (one - exponential) / (one + exponential);
                let sum = one + exponential;
                // One less the square, to all digits also where that is nearly one.
                let slope = L::splat(4.0) * exponential / (sum * sum);
                [L::select(x.lt(zero), -size, size), slope]
            }
        }
    }
}

//! The colours that a study sets for attractors: by name, or by red, green and blue.

use std::collections::BTreeMap;

use super::document::unknown;

/// A colour: red, green and blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colour(pub [u8; 3]);

/// The colours of attractors, by their numbers in the file of results.
pub type AttractorColours = BTreeMap<u32, Colour>;

impl Colour {
    /// Each that has a name. The first seven are those that figures choose by themselves, in their order.
    pub const NAMES: [(&'static str, Colour); 11] = [
        ("blue", Colour([0, 114, 178])),
        ("vermilion", Colour([213, 94, 0])),
        ("green", Colour([0, 158, 115])),
        ("pink", Colour([204, 121, 167])),
        ("orange", Colour([230, 159, 0])),
        ("light-blue", Colour([86, 180, 233])),
        ("wine", Colour([136, 34, 85])),
        ("indigo", Colour([51, 34, 136])),
        ("sand", Colour([221, 204, 119])),
        ("grey", Colour([90, 90, 90])),
        ("black", Colour([0, 0, 0])),
    ];

    /// The colour that a text names, as "blue" or "#0072b2".
    ///
    /// # Errors
    ///
    /// Says what is allowed.
    pub fn parse(text: &str) -> Result<Colour, String> {
        if let Some(digits) = text.strip_prefix('#') {
            let expected =
                || format!("\"{text}\" is no colour; expected six digits, as \"#d55e00\"");
            return channels(digits).ok_or_else(expected);
        }
        let named = Colour::NAMES.iter().find(|it| it.0 == text).map(|it| it.1);
        let fault = || unknown("colour", text, Colour::NAMES.iter().map(|it| it.0));
        named.ok_or_else(|| format!("{}, or red, green and blue, as \"#d55e00\"", fault()))
    }

    /// The same as text: its name if it has one.
    pub fn text(self) -> String {
        let Colour([red, green, blue]) = self;
        let named = Colour::NAMES.iter().find(|it| it.1 == self).map(|it| it.0.to_owned());
        named.unwrap_or_else(|| format!("#{red:02x}{green:02x}{blue:02x}"))
    }
}

/// The colour of six hexadecimal digits.
fn channels(digits: &str) -> Option<Colour> {
    let is_whole = digits.len() == 6 && digits.bytes().all(|it| it.is_ascii_hexdigit());
    let number = u32::from_str_radix(digits, 16).ok().filter(|_| is_whole)?;
    let [_, red, green, blue] = number.to_be_bytes();
    Some(Colour([red, green, blue]))
}

/// The number of an attractor as it stands before its colour.
///
/// # Errors
///
/// Says what is expected.
pub fn attractor_number(text: &str) -> Result<u32, String> {
    let is_plain = text.bytes().all(|it| it.is_ascii_digit());
    let number = text.parse().ok().filter(|_| is_plain);
    number.ok_or_else(|| {
        format!("\"{text}\" is no number of an attractor; expected 0, 1, 2 and so on, as in the file of results")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_read_as_they_are_written() {
        for (name, colour) in Colour::NAMES {
            assert_eq!(Colour::parse(name), Ok(colour));
            assert_eq!(colour.text(), name);
        }
        let other = Colour([1, 254, 160]);
        assert_eq!(other.text(), "#01fea0");
        assert_eq!(Colour::parse("#01FEA0"), Ok(other));
        for wrong in ["", "#", "#12345", "#1234567", "#+12345", "#12345g", "Blue", "red "] {
            let fault = Colour::parse(wrong).expect_err(wrong);
            assert!(fault.contains("#d55e00"), "{fault}");
        }
        assert_eq!(attractor_number("12"), Ok(12));
        for wrong in ["", "-1", "+1", "1.0", "one", "99999999999"] {
            assert!(attractor_number(wrong).is_err(), "{wrong}");
        }
    }
}

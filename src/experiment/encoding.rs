//! The text of a recording, in the encoding in which a program of a laboratory has written it.

/// So many bytes say whether a file without a mark of its encoding has two bytes for a character.
const LOOKED_AT: usize = 4096;
/// Of characters of two bytes this share has a zero byte, as digits and separators have.
const PLAIN: f64 = 0.6;

/// How the characters of a file are written as bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// UTF-8, of which ASCII is a part.
    Utf8,
    /// UTF-16 with the less significant byte first.
    Utf16Little,
    /// UTF-16 with the more significant byte first.
    Utf16Big,
    /// ISO 8859-1, a byte for each character.
    Latin1,
}

/// The text of bytes.
///
/// A mark at the beginning says what the encoding is. Without one it is UTF-16 where most bytes of one parity are zero, UTF-8 where that
/// is what the bytes are, and Latin-1 else.
///
/// Fails with the line, counted from 1, at which the bytes are no text.
pub fn decoded(bytes: Vec<u8>) -> Result<String, usize> {
    match encoding_of(&bytes) {
        Encoding::Utf8 => String::from_utf8(bytes)
            .map_err(|error| line_after(&error.as_bytes()[..error.utf8_error().valid_up_to()])),
        Encoding::Utf16Little => of_pairs(&bytes, u16::from_le_bytes),
        Encoding::Utf16Big => of_pairs(&bytes, u16::from_be_bytes),
        Encoding::Latin1 => of_latin1(&bytes),
    }
}

/// The encoding of bytes.
pub fn encoding_of(bytes: &[u8]) -> Encoding {
    match bytes {
        [0xff, 0xfe, ..] => return Encoding::Utf16Little,
        [0xfe, 0xff, ..] => return Encoding::Utf16Big,
        [0xef, 0xbb, 0xbf, ..] => return Encoding::Utf8,
        _ => {}
    }
    let first = &bytes[..bytes.len().min(LOOKED_AT) & !1];
    let zeros = |from: usize| first.iter().skip(from).step_by(2).filter(|it| **it == 0).count();
    let [even, odd] = [zeros(0), zeros(1)].map(|it| it as f64 / (first.len() / 2).max(1) as f64);
    if odd > PLAIN && even < 1.0 - PLAIN {
        Encoding::Utf16Little
    } else if even > PLAIN && odd < 1.0 - PLAIN {
        Encoding::Utf16Big
    } else if std::str::from_utf8(bytes).is_ok() {
        Encoding::Utf8
    } else {
        Encoding::Latin1
    }
}

/// Text of two bytes for each unit.
fn of_pairs(bytes: &[u8], unit: impl Fn([u8; 2]) -> u16) -> Result<String, usize> {
    let pairs = bytes.chunks_exact(2);
    let rest = pairs.remainder();
    let units = pairs.map(|pair| unit([pair[0], pair[1]]));
    let mut text = String::with_capacity(bytes.len() / 2);
    for character in char::decode_utf16(units) {
        match character {
            Ok(character) => text.push(character),
            Err(_) => return Err(line_after(text.as_bytes())),
        }
    }
    match rest {
        [] => Ok(text),
        _ => Err(line_after(text.as_bytes())),
    }
}

/// Text of a byte for each character; bytes that no text has, as those of a compressed file, are refused.
fn of_latin1(bytes: &[u8]) -> Result<String, usize> {
    let is_text = |byte: &u8| *byte >= 0x20 || b"\t\n\r\x0c".contains(byte);
    match bytes.iter().position(|byte| !is_text(byte)) {
        Some(place) => Err(line_after(&bytes[..place])),
        None => Ok(bytes.iter().map(|byte| char::from(*byte)).collect()),
    }
}

/// The line in which the next byte stands.
fn line_after(before: &[u8]) -> usize {
    before.iter().filter(|byte| **byte == b'\n').count() + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "Zeit [µs];Länge (mm)\r\n0;1,5\r\n1;2,5\r\n";

    fn pairs(text: &str, bytes: impl Fn(u16) -> [u8; 2]) -> Vec<u8> {
        text.encode_utf16().flat_map(bytes).collect()
    }

    #[test]
    fn a_text_is_the_same_in_every_encoding() {
        let marked = format!("\u{feff}{TEXT}");
        let latin1 = TEXT.chars().map(|it| u8::try_from(u32::from(it)).expect("Latin-1"));
        for (bytes, encoding) in [
            (TEXT.as_bytes().to_vec(), Encoding::Utf8),
            (marked.as_bytes().to_vec(), Encoding::Utf8),
            (pairs(TEXT, u16::to_le_bytes), Encoding::Utf16Little),
            (pairs(&marked, u16::to_le_bytes), Encoding::Utf16Little),
            (pairs(TEXT, u16::to_be_bytes), Encoding::Utf16Big),
            (pairs(&marked, u16::to_be_bytes), Encoding::Utf16Big),
            (latin1.collect(), Encoding::Latin1),
        ] {
            assert_eq!(encoding_of(&bytes), encoding);
            let text = decoded(bytes).expect("a text");
            assert_eq!(text.trim_start_matches('\u{feff}'), TEXT, "{encoding:?}");
        }
    }

    #[test]
    fn bytes_that_are_no_text_are_refused_with_their_line() {
        assert_eq!(decoded(b"t [s],r [m]\n0,1\n\x1f\x8b\x08\xff".to_vec()), Err(3));
        let mut lone = pairs("\u{feff}t\n0\n", u16::to_le_bytes);
        lone.extend([0x00, 0xd8]);
        assert_eq!(decoded(lone), Err(3));
        let mut cut = pairs("\u{feff}t\n", u16::to_le_bytes);
        cut.push(b'0');
        assert_eq!(decoded(cut), Err(2));
        assert_eq!(decoded(Vec::new()), Ok(String::new()));
    }
}

//! The mark of a figure's file, by which the program knows it again: no other file is replaced.
//!
//! It holds a checksum of the rest, so that a figure that was changed by hand is known for another. Each format keeps it
//! where readers ignore it: SVG, PDF and CSV in a comment at the end, PNG in a chunk of its own before the last.

use super::format::Format;

/// Before the checksum in a comment.
const NAME: &str = "capsulemap ";
/// The chunk of a PNG: one that readers may ignore and that is of no public kind.
const CHUNK: [u8; 4] = *b"caPm";
/// The last chunk of a PNG: no data, its kind, and its checksum.
const LAST: [u8; 12] = *b"\0\0\0\0IEND\xae\x42\x60\x82";

/// Adds the mark to the bytes of a file.
pub fn add(format: Format, mut bytes: Vec<u8>) -> Vec<u8> {
    let body = match format {
        Format::Png => bytes.len().saturating_sub(LAST.len()),
        Format::Svg | Format::Pdf | Format::Csv => bytes.len(),
    };
    let mark = mark(format, crc32fast::hash(&bytes[..body]));
    bytes.splice(body..body, mark);
    bytes
}

/// Whether a file has the mark and has not changed since.
pub fn is_valid(format: Format, bytes: &[u8]) -> bool {
    let end: &[u8] = match format {
        Format::Png => &LAST,
        Format::Svg | Format::Pdf | Format::Csv => &[],
    };
    let Some(marked) = bytes.strip_suffix(end) else { return false };
    let length = mark(format, 0).len();
    let Some(body) = marked.len().checked_sub(length) else { return false };
    let (body, found) = marked.split_at(body);
    found == mark(format, crc32fast::hash(body))
}

/// The mark with a checksum.
fn mark(format: Format, sum: u32) -> Vec<u8> {
    match format {
        Format::Svg => format!("<!-- {NAME}{sum:08x} -->\n").into_bytes(),
        Format::Pdf => format!("\n%{NAME}{sum:08x}\n").into_bytes(),
        Format::Csv => format!("# {NAME}{sum:08x}\n").into_bytes(),
        Format::Png => {
            let inside = [CHUNK, sum.to_be_bytes()].concat();
            let own = crc32fast::hash(&inside);
            [&4_u32.to_be_bytes()[..], &inside, &own.to_be_bytes()].concat()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_without_the_mark_or_changed_is_another() {
        let png = [b"\x89PNG\r\n\x1a\n some chunks".to_vec(), LAST.to_vec()].concat();
        for (format, file) in [
            (Format::Png, png),
            (Format::Svg, b"<svg></svg>\n".to_vec()),
            (Format::Pdf, b"%PDF-1.7 %%EOF".to_vec()),
            (Format::Csv, b"panel,x,y\n".to_vec()),
        ] {
            assert!(!is_valid(format, &file));
            let marked = add(format, file);
            assert!(is_valid(format, &marked));
            for place in 0..marked.len() {
                let mut changed = marked.clone();
                changed[place] ^= 1;
                assert!(!is_valid(format, &changed), "{format:?} {place}");
                assert!(!is_valid(format, &marked[..place]), "{format:?} {place}");
            }
            assert!(!is_valid(format, &[&marked[..], b"\n"].concat()));
        }
    }
}

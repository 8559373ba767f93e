//! The embedded fonts: how wide a text is, and which characters they can draw.

use std::sync::{Arc, OnceLock};

use ab_glyph::{Font, FontRef};
use resvg::usvg::fontdb::{Database, Family, Query, Source, Style, Weight};

use super::style::FAMILY;

/// A face of the family.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// Upright.
    Regular,
    /// Slanted, for symbols.
    Italic,
    /// Heavy, for panel letters.
    Bold,
}

/// The fonts, parsed once: the database the renderers read and the faces measured here.
struct Fonts {
    database: Arc<Database>,
    faces: [Option<FontRef<'static>>; 3],
}

/// The parsed fonts.
fn fonts() -> &'static Fonts {
    static FONTS: OnceLock<Fonts> = OnceLock::new();
    FONTS.get_or_init(|| {
        let mut database = Database::new();
        let mut faces = [None, None, None];
        for data in typst_assets::fonts() {
            let ids = database.load_font_source(Source::Binary(Arc::new(data)));
            for id in ids {
                let ours = database
                    .face(id)
                    .is_some_and(|face| face.families.iter().any(|(name, _)| name == FAMILY));
                if !ours {
                    database.remove_face(id);
                }
            }
            for (index, face) in [Face::Regular, Face::Italic, Face::Bold].into_iter().enumerate() {
                if faces[index].is_none() && is_face(&database, face, data) {
                    faces[index] = FontRef::try_from_slice(data).ok();
                }
            }
        }
        Fonts { database: Arc::new(database), faces }
    })
}

/// Whether the font file `data` is where `database` finds `face`, exactly and not as a substitute.
fn is_face(database: &Database, face: Face, data: &[u8]) -> bool {
    let (style, weight) = match face {
        Face::Regular => (Style::Normal, Weight::NORMAL),
        Face::Italic => (Style::Italic, Weight::NORMAL),
        Face::Bold => (Style::Normal, Weight::BOLD),
    };
    let families = [Family::Name(FAMILY)];
    let query = Query { families: &families, weight, style, ..Query::default() };
    let Some(id) = database.query(&query) else { return false };
    let exact = database.face(id).is_some_and(|it| it.style == style && it.weight == weight);
    let same = database
        .with_face_data(id, |found, _| std::ptr::eq(found.as_ptr(), data.as_ptr()))
        .unwrap_or(false);
    exact && same
}

/// The font database for the renderers.
pub fn database() -> Arc<Database> {
    Arc::clone(&fonts().database)
}

/// Whether `face` can draw `character`.
pub fn has_glyph(face: Face, character: char) -> bool {
    fonts().faces[face as usize].as_ref().is_some_and(|font| font.glyph_id(character).0 != 0)
}

/// Width of `content` set in `face` at one point of size [pt].
pub fn width(face: Face, content: &str) -> f64 {
    let Some(font) = &fonts().faces[face as usize] else { return 0.0 };
    let units = f64::from(font.units_per_em().unwrap_or(1000.0));
    let advances = content.chars().map(|c| f64::from(font.h_advance_unscaled(font.glyph_id(c))));
    advances.sum::<f64>() / units
}

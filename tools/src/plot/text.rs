//! Text drawn with the font that Airlight brings along, so that a picture is the same everywhere.
//!
//! The font is DejaVu Sans, cut down to Latin, Greek, and raised and lowered digits.

use super::model::Colour;
use ab_glyph::{Font, FontRef, InvalidFont, PxScale, ScaleFont, point};
use plotters_backend::text_anchor::{HPos, Pos, VPos};
use plotters_backend::{BackendColor, BackendCoord, BackendTextStyle, FontFamily, FontTransform};

const FONT: &[u8] = include_bytes!("../../assets/DejaVuSans-subset.ttf");

/// What a vector picture asks its viewer for; all of these have the same widths or nearly so.
const FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";

/// Distance of the baseline from the top of a text and of the bottom from the baseline, in em, so
/// that vector and bitmap pictures put it at the same place.
const BASELINE: f64 = 0.76;
const DEPTH: f64 = 0.22;

/// The look of a text: its size in device units (1 em) and where its anchor lies in it.
#[derive(Clone)]
pub(super) struct Label<'f> {
    font: &'f FontRef<'static>,
    pub(super) size: f64,
    pub(super) colour: Colour,
    pub(super) anchor: (HPos, VPos),
    pub(super) upwards: bool,
}

/// The font, from the bytes in the program.
pub(super) fn font() -> Result<FontRef<'static>, InvalidFont> {
    FontRef::try_from_slice(FONT)
}

impl<'f> Label<'f> {
    pub(super) fn new(
        font: &'f FontRef<'static>,
        size: f64,
        colour: Colour,
        anchor: (HPos, VPos),
        upwards: bool,
    ) -> Self {
        Self { font, size, colour, anchor, upwards }
    }

    fn scale(&self) -> PxScale {
        let units_per_em = self.font.units_per_em().unwrap_or(2048.0);
        PxScale::from(self.size as f32 * self.font.height_unscaled() / units_per_em)
    }

    /// The glyphs of a text with the distances of their origins from its start, and its width.
    fn layout(&self, text: &str) -> (Vec<(char, f32)>, f32) {
        let font = self.font.as_scaled(self.scale());
        let mut place = 0.0;
        let mut previous = None;
        let mut glyphs = Vec::new();
        for c in text.chars() {
            let id = font.glyph_id(c);
            place += previous.map_or(0.0, |p| font.kern(p, id));
            glyphs.push((c, place));
            place += font.h_advance(id);
            previous = Some(id);
        }
        (glyphs, place)
    }

    /// Width of a text in device units.
    pub(super) fn width(&self, text: &str) -> f64 {
        f64::from(self.layout(text).1)
    }
}

impl BackendTextStyle for Label<'_> {
    type FontError = InvalidFont;

    fn color(&self) -> BackendColor {
        BackendColor { alpha: 1.0, rgb: self.colour }
    }

    fn size(&self) -> f64 {
        // The vector backend divides by this.
        self.size * 1.24
    }

    fn transform(&self) -> FontTransform {
        if self.upwards { FontTransform::Rotate270 } else { FontTransform::None }
    }

    fn anchor(&self) -> Pos {
        Pos::new(self.anchor.0, self.anchor.1)
    }

    fn family(&self) -> FontFamily<'_> {
        FontFamily::Name(FAMILY)
    }

    fn layout_box(&self, text: &str) -> Result<((i32, i32), (i32, i32)), InvalidFont> {
        let height = self.size * (BASELINE + DEPTH);
        Ok(((0, 0), (self.width(text).round() as i32, height.round() as i32)))
    }

    fn draw<E, DrawFunc: FnMut(i32, i32, BackendColor) -> Result<(), E>>(
        &self,
        text: &str,
        pos: BackendCoord,
        mut draw: DrawFunc,
    ) -> Result<Result<(), E>, InvalidFont> {
        let baseline = (self.size * BASELINE) as f32;
        for (c, place) in self.layout(text).0 {
            let glyph = self.font.glyph_id(c).with_scale_and_position(self.scale(), point(place, baseline));
            let Some(outline) = self.font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            let mut result = Ok(());
            outline.draw(|x, y, coverage| {
                if result.is_ok() && coverage > 0.0 {
                    let (x, y) = (pos.0 + corner.x as i32 + x as i32, pos.1 + corner.y as i32 + y as i32);
                    result = draw(x, y, BackendColor { alpha: coverage.min(1.0).into(), rgb: self.colour });
                }
            });
            if result.is_err() {
                return Ok(result);
            }
        }
        Ok(Ok(()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_every_letter_that_labels_use() {
        let font = font().expect("a font");
        for c in "AZaz09 .,:;()/%°µσλτρ²³⁻⁰¹⁴⁵⁶⁷⁸⁹₀₃−–×·".chars() {
            assert_ne!(font.glyph_id(c).0, 0, "{c:?} is not in the font");
        }
    }

    #[test]
    fn longer_texts_are_wider() {
        let font = font().expect("a font");
        let label = Label::new(&font, 20.0, (0, 0, 0), (HPos::Left, VPos::Top), false);
        assert!(label.width("mm") > label.width("m") && label.width("m") > 15.0);
        assert_eq!(label.width(""), 0.0);
    }
}

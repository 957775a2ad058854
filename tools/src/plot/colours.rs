//! Colours that colour-blind eyes tell apart.

use super::model::Colour;

/// Black.
pub const BLACK: Colour = (0, 0, 0);
/// White.
pub const WHITE: Colour = (255, 255, 255);
/// Grey of grid lines.
pub const GRID: Colour = (226, 226, 226);
/// Grey of what is only compared with.
pub const GREY: Colour = (120, 120, 120);

// Okabe and Ito, Color Universal Design, 2008.

/// Blue of Okabe and Ito.
pub const BLUE: Colour = (0, 114, 178);
/// Vermilion of Okabe and Ito.
pub const VERMILION: Colour = (213, 94, 0);
/// Bluish green of Okabe and Ito.
pub const GREEN: Colour = (0, 158, 115);
/// Orange of Okabe and Ito.
pub const ORANGE: Colour = (230, 159, 0);
/// Reddish purple of Okabe and Ito.
pub const PURPLE: Colour = (204, 121, 167);
/// Sky blue of Okabe and Ito.
pub const SKY: Colour = (86, 180, 233);

/// Eleven equidistant colours of viridis (S. van der Walt and N. Smith, 2015, CC0).
const VIRIDIS: [Colour; 11] = [
    (68, 1, 84),
    (72, 36, 117),
    (65, 68, 135),
    (53, 95, 141),
    (42, 120, 142),
    (33, 145, 140),
    (34, 168, 132),
    (68, 191, 112),
    (122, 209, 81),
    (189, 223, 38),
    (253, 231, 37),
];

/// Colours of mid-January, April, July and October: the year goes from dark to light and back, by
/// blue in spring and by orange in autumn, which no common colour blindness confuses.
const SEASONS: [Colour; 4] = [(38, 20, 70), (20, 120, 215), (150, 195, 150), (225, 105, 20)];

/// The colour at a fraction 0..=1 of the way from dark violet to yellow.
#[must_use]
pub fn viridis(fraction: f64) -> Colour {
    let place = fraction.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let index = (place as usize).min(VIRIDIS.len() - 2);
    mixed(VIRIDIS[index], VIRIDIS[index + 1], place - index as f64)
}

/// The colour of a month, 1 to 12; December and January are neighbours.
#[must_use]
pub fn month(month: u8) -> Colour {
    let place = f64::from((month + 11) % 12) / 3.0;
    let index = place as usize;
    mixed(SEASONS[index % 4], SEASONS[(index + 1) % 4], place - index as f64)
}

/// Black or white, whichever is better read on `colour`.
#[must_use]
pub fn on(colour: Colour) -> Colour {
    let (r, g, b) = colour;
    let luma = 0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b);
    if luma > 112.0 { BLACK } else { WHITE }
}

fn mixed(a: Colour, b: Colour, fraction: f64) -> Colour {
    let mix = |a: u8, b: u8| (f64::from(a) + fraction * (f64::from(b) - f64::from(a))).round() as u8;
    (mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_begin_and_end_where_they_should() {
        assert_eq!((viridis(0.0), viridis(1.0)), (VIRIDIS[0], VIRIDIS[10]));
        assert_eq!((viridis(-1.0), viridis(2.0)), (VIRIDIS[0], VIRIDIS[10]));
        assert_eq!((month(1), month(10)), (SEASONS[0], SEASONS[3]));
        assert_ne!(month(12), month(1));
        assert_eq!((on(BLACK), on(WHITE)), (WHITE, BLACK));
    }
}

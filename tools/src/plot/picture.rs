//! A figure as the bytes of an SVG or PNG file.

use super::PlotError;
use super::canvas::{Canvas, FINENESS};
use super::layout::{SIZE, draw};
use super::model::Figure;
use plotters::backend::{BitMapBackend, SVGBackend};

/// Pixels of a bitmap per metre: 200 per inch, so that a picture is 203 mm wide.
const PIXELS_PER_METRE: u32 = 7874;

/// The figure as an SVG document, 1600 by 1000 units of the viewer.
///
/// # Errors
/// [`PlotError::Drawing`].
pub fn svg(figure: &Figure) -> Result<Vec<u8>, PlotError> {
    let (width, height) = (SIZE.0 * FINENESS, SIZE.1 * FINENESS);
    let mut text = String::new();
    let mut canvas = Canvas::new(SVGBackend::with_string(&mut text, (width, height)), false)?;
    draw(&mut canvas, figure)?;
    canvas.finish()?;
    // The device units stay in the view box; the picture itself has the size of the bitmap.
    let device = format!("width=\"{width}\" height=\"{height}\"");
    let picture = format!("width=\"{}\" height=\"{}\" stroke-linejoin=\"round\"", SIZE.0, SIZE.1);
    Ok(joined(&text.replacen(&device, &picture, 1)).into_bytes())
}

/// The document with lines of one look that follow each other, such as the dots of a curve, made one path: a quarter
/// of its size.
fn joined(document: &str) -> String {
    fn close(text: &mut String, head: &str, runs: &mut Vec<&str>) {
        match runs.as_slice() {
            [] => {}
            [one] => text.push_str(&format!("<polyline{head}points=\"{one}\"/>\n")),
            many => text.push_str(&format!("<path{head}d=\"M{}\"/>\n", many.join("M"))),
        }
        runs.clear();
    }
    let (mut text, mut looks, mut runs) = (String::new(), "", Vec::new());
    for line in document.lines() {
        let inside = line.strip_prefix("<polyline").and_then(|rest| rest.strip_suffix("\"/>"));
        let Some((head, points)) = inside.and_then(|inside| inside.split_once("points=\"")) else {
            close(&mut text, looks, &mut runs);
            text.push_str(line);
            text.push('\n');
            continue;
        };
        if head != looks {
            close(&mut text, looks, &mut runs);
            looks = head;
        }
        runs.push(points.trim_end());
    }
    close(&mut text, looks, &mut runs);
    text
}

/// The figure as a PNG image of 1600 by 1000 pixels, each the mean of the finer ones drawn.
///
/// # Errors
/// [`PlotError::Drawing`].
pub fn png(figure: &Figure) -> Result<Vec<u8>, PlotError> {
    let (width, height) = (SIZE.0 * FINENESS, SIZE.1 * FINENESS);
    let mut fine = vec![255_u8; width as usize * height as usize * 3];
    let mut canvas = Canvas::new(BitMapBackend::with_buffer(&mut fine, (width, height)), true)?;
    draw(&mut canvas, figure)?;
    canvas.finish()?;

    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIZE.0, SIZE.1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    // Flat colours and repeated letters: rows as they are pack better than differences of neighbours.
    encoder.set_filter(png::Filter::NoFilter);
    let unit = png::Unit::Meter;
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: PIXELS_PER_METRE, yppu: PIXELS_PER_METRE, unit }));
    let mut writer = encoder.write_header().map_err(PlotError::drawing)?;
    writer.write_image_data(&reduced(&fine)).map_err(PlotError::drawing)?;
    writer.finish().map_err(PlotError::drawing)?;
    Ok(bytes)
}

/// Means over squares of pixels.
fn reduced(fine: &[u8]) -> Vec<u8> {
    let n = FINENESS as usize;
    let row = SIZE.0 as usize * n * 3;
    let mut coarse = Vec::with_capacity(fine.len() / (n * n));
    for band in fine.chunks_exact(row * n) {
        for x in 0..SIZE.0 as usize {
            for channel in 0..3 {
                let sum: u32 = (0..n * n).map(|i| u32::from(band[(i / n) * row + (x * n + i % n) * 3 + channel])).sum();
                coarse.push(((sum + (n * n / 2) as u32) / (n * n) as u32) as u8);
            }
        }
    }
    coarse
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::colours::BLUE;
    use crate::plot::model::{Axis, Cells, Curve, Panel};

    fn figure() -> Figure {
        let curve = Curve::new("a line", BLUE, vec![(0.0, 0.0), (1.0, 1.0)]);
        let panel = Panel::new(Axis::linear("x", 0.0, 1.0, 0.5), Axis::linear("y < z", 0.0, 1.0, 0.5), vec![curve]);
        Figure::new("title", vec![vec![panel]])
    }

    #[test]
    fn a_bitmap_is_white_with_ink_on_it_and_always_the_same() {
        let bytes = png(&figure()).expect("drawn");
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
        let info = reader.next_frame(&mut pixels).expect("decoded");
        assert_eq!((info.width, info.height), SIZE);
        let white = pixels.iter().filter(|&&v| v == 255).count() as f64 / pixels.len() as f64;
        assert!((0.9..0.999).contains(&white), "{white} of it is white");
        assert_eq!(bytes, png(&figure()).expect("drawn"));
    }

    #[test]
    fn joined_maps_share_labels_and_bar_and_show_what_is_infinite() {
        let values = vec![((0.0, 0.0, 1.0, 1.0), 1.0), ((1.0, 0.0, 2.0, 1.0), f64::INFINITY)];
        let map = |label: &str, name: &str, bar: bool| {
            let scale = Axis::linear("shade", 0.0, 2.0, 1.0);
            let infinite = Some("beyond".to_owned());
            let cells = Cells { numbered: false, bar, infinite, ..Cells::new(scale, values.clone()) };
            let y = Axis::linear(label, 0.0, 1.0, 1.0).named(vec![(0.5, name.into())]);
            Panel { cells: Some(cells), ..Panel::new(Axis::linear("x", 0.0, 2.0, 1.0), y, Vec::new()) }
        };
        let rows = vec![vec![map("kind", "a very long name", false), map("", "", true)]];
        let text = String::from_utf8(svg(&Figure::new("", rows)).expect("drawn")).expect("UTF-8");
        let count = |part: &str| text.matches(part).count();
        assert_eq!([count("a very long name"), count("shade"), count("beyond")], [1, 1, 1]);
        // The infinite cell of each map and the sample under the bar are filled with the grey of the key.
        assert_eq!(count("#787878"), 3);
        // Equal cells are equally wide in both.
        let widths: Vec<&str> = text
            .lines()
            .filter(|line| line.starts_with("<rect") && line.contains("#787878"))
            .filter_map(|line| line.split("width=\"").nth(1)?.split('"').next())
            .collect();
        assert_eq!(widths[0], widths[1], "{widths:?}");
    }

    #[test]
    fn lines_of_one_look_become_one_path() {
        let line = |look: &str, points: &str| format!("<polyline {look} points=\"{points} \"/>\n");
        let document = [line("a", "1,2 3,4"), line("a", "5,6 7,8"), line("b", "1,1 2,2"), "<text>\n".into()].concat();
        let expected = "<path a d=\"M1,2 3,4M5,6 7,8\"/>\n<polyline b points=\"1,1 2,2\"/>\n<text>\n";
        assert_eq!(joined(&document), expected);
    }

    #[test]
    fn a_vector_picture_has_its_texts() {
        let text = String::from_utf8(svg(&figure()).expect("drawn")).expect("UTF-8");
        assert!(text.starts_with("<svg width=\"1600\" height=\"1000\"") && text.trim_end().ends_with("</svg>"));
        for expected in ["a line", "title", "y &lt; z", "polyline", "0 0 4800 3000"] {
            assert!(text.contains(expected), "{expected:?} is not in {text}");
        }
    }
}

//! Probes: the expected values of pixels.

use super::words::Words;
use super::{TestResult, fail, skip};
use glisten_scene::picture::Picture;

/// A rectangle in window coordinates, with the origin at the lower left.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Area {
    x: u32,
    y: u32,
    width: u32,
    height: u32,
}

/// A parsed probe.
struct Probe {
    area: Area,
    /// The expected channels: 3 or 4.
    color: Vec<f64>,
    /// Whether a difference is only a warning, which no test fails by.
    warns: bool,
}

/// Whether a line is a probe at all.
pub(super) fn is_probe(words: &Words<'_>) -> bool {
    matches!(words.rest(), ["probe", ..] | ["relative", "probe", ..])
}

/// Parses a probe and compares it with the picture.
pub(super) fn check(mut words: Words<'_>, picture: &Picture, tolerance: [f64; 4]) -> Result<(), TestResult> {
    let line = words.line;
    let probe = parse(&mut words, [picture.width, picture.height])?;
    words.end()?;
    let pixels = picture.attachments.first().map(Vec::as_slice).unwrap_or_default();
    for y in probe.area.y..probe.area.y.saturating_add(probe.area.height) {
        for x in probe.area.x..probe.area.x.saturating_add(probe.area.width) {
            let Some(row) = picture.height.checked_sub(y + 1).filter(|_| x < picture.width) else {
                return fail(line, format_args!("the probe looks at ({x}, {y}), outside of the window"));
            };
            let index = row as usize * picture.width as usize + x as usize;
            let Some(color) = pixels.get(index) else { continue };
            // A NaN is not near anything.
            let near = |((seen, wanted), tolerance): ((&f64, &f64), &f64)| (seen - wanted).abs() <= *tolerance;
            if !probe.warns && !color.iter().zip(&probe.color).zip(&tolerance).all(near) {
                return fail(
                    line,
                    format_args!(
                        "pixel ({x}, {y}) is {}, not {}",
                        tuple(&color[..probe.color.len()]),
                        tuple(&probe.color)
                    ),
                );
            }
        }
    }
    Ok(())
}

fn tuple(channels: &[f64]) -> String {
    let list: Vec<String> = channels.iter().map(|channel| format!("{}", *channel as f32)).collect();
    format!("({})", list.join(", "))
}

/// Parses all forms of probes, in pixels or relative to the window's size.
fn parse(words: &mut Words<'_>, size: [u32; 2]) -> Result<Probe, TestResult> {
    let line = words.line;
    let relative = words.eat("relative");
    words.eat("probe");
    let warns = words.eat("warn");
    let everything = words.eat("all");
    let rectangle = !everything && words.eat("rect");
    let channels = match words.word()? {
        "rgba" => 4,
        "rgb" => 3,
        "depth" => return skip(line, "`probe depth`: the depth buffer is not read back"),
        other => return skip(line, format_args!("`probe {other}` is not supported")),
    };
    if words.eat("int") || words.eat("uint") {
        // The colors of an integer framebuffer, as numbers.
    }
    let area = if everything {
        Area { x: 0, y: 0, width: size[0], height: size[1] }
    } else {
        let [x, y] = words.numbers()?;
        let [width, height] = if rectangle { words.numbers()? } else { [1.0, 1.0] };
        let sides = if relative {
            relative_sides([x, y], rectangle.then_some([width, height]), size)
        } else {
            [x, y, width, height]
        };
        area(line, sides)?
    };
    let mut color = Vec::new();
    for _ in 0..channels {
        color.push(words.number()?);
    }
    // shader_runner passes over an alpha that `rgb` does not compare, and tests of piglit have one.
    if channels == 3 && !words.rest().is_empty() {
        words.number()?;
    }
    Ok(Probe { area, color, warns })
}

/// The pixels of a rectangle; as in C, fractions are dropped.
fn area(line: u32, sides: [f64; 4]) -> Result<Area, TestResult> {
    let [x, y, width, height] = sides.map(f64::trunc);
    let last = f64::from(u32::MAX);
    if !((0.0..last).contains(&x) && (0.0..last).contains(&y)) {
        return fail(line, format_args!("the probe looks at ({x}, {y}), outside of the window"));
    }
    if !(width >= 1.0 && height >= 1.0) {
        return fail(line, format_args!("the probe looks at no pixel: it is {width} by {height} pixels large"));
    }
    Ok(Area { x: x as u32, y: y as u32, width: width as u32, height: height as u32 })
}

/// A rectangle in fractions of the window. A point on the far edge is in the last pixel.
fn relative_sides(corner: [f64; 2], extent: Option<[f64; 2]>, size: [u32; 2]) -> [f64; 4] {
    let scaled = |fraction: [f64; 2]| [fraction[0] * f64::from(size[0]), fraction[1] * f64::from(size[1])];
    let [x, y] = scaled(corner);
    match extent.map(scaled) {
        Some([width, height]) => [x, y, width, height],
        None => {
            let inside = |at: f64, size: u32| if at >= f64::from(size) { f64::from(size - 1) } else { at };
            [inside(x, size[0]), inside(y, size[1]), 1.0, 1.0]
        }
    }
}

#[cfg(test)]
mod unit {
    use super::*;

    /// Two by two pixels: red at the lower left, NaN at the upper right.
    fn picture() -> Picture {
        let nan = [f64::NAN, 0.0, 0.0, 1.0];
        Picture::of_colors(2, 2, vec![[0.0; 4], nan, [1.0, 0.0, 0.0, 1.0], [0.0, 0.5, 0.0, 1.0]])
    }

    fn check(text: &str) -> Result<(), TestResult> {
        super::check(Words::new(7, text), &picture(), [0.01; 4])
    }

    #[test]
    fn every_form() {
        for good in [
            "probe rgba 0 0 1 0 0 1",
            "probe rgb 1 0 0 0.5 0",
            "probe rgb 1 0 0 0.5 0 0",
            "relative probe rgba (0.0, 0.0) (1, 0, 0, 1)",
            "relative probe rgb (0.5, 0.0) (0, 0.505, 0)",
            "probe rect rgba (0, 0, 1, 1) (1, 0, 0, 1)",
            "relative probe rect rgb (0.5, 0.0, 0.5, 0.5) (0, 0.5, 0)",
            "probe rgba -0.5 0 1 0 0 1",
            "relative probe rgb (1.0, 0.0) (0, 0.5, 0)",
            "probe warn all rgba 0 0 0 0",
        ] {
            assert_eq!(check(good), Ok(()), "{good}");
        }
        for bad in [
            "probe rgba 0 0 1 0 0 0",
            "probe rgb 1 1 0 0 0",
            "probe all rgb 1 0 0",
            "probe rgb 2 0 0 0 0",
            "probe rgb 0 0 1 0 0 1 1",
            "probe rgba 0 0 1 0 0 1 1",
            "relative probe rect rgb (0, 0, 1, 0.5) (1, 0, 0)",
            "probe rgba -1 0 1 0 0 1",
            "probe rgba nan 0 1 0 0 1",
            "probe rgba 1e20 0 1 0 0 1",
            "probe rect rgba (-1, 0, 2, 1) (1, 0, 0, 1)",
            "probe rect rgba (0, 0, -1, 1) (1, 0, 0, 1)",
            "relative probe rgba (-0.5, 0.5) (1, 0, 0, 1)",
            "relative probe rect rgba (0, 0, 0.05, 0.05) (1, 0, 0, 1)",
        ] {
            assert!(matches!(check(bad), Err(TestResult::Fail(_))), "{bad}");
        }
        assert!(matches!(check("probe depth 0 0 1"), Err(TestResult::Skip(_))));
    }
}

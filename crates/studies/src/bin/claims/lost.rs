//! Do colors at vertices lose the highlight? And does interpolation without perspective bend (figure 137)?

use super::scenes::{Ball, By, Highlight, Place, errors, loaded, picture, scene};
use glisten::Picture;
use glisten::scene::MemoryFiles;
use std::fmt::Write;

const SEGMENTS: [u32; 6] = [8, 16, 32, 64, 128, 256];
const EXPONENT: u32 = 32;
const SIZE: u32 = 256;

/// Both tables.
pub(crate) fn tables() -> Result<String, String> {
    Ok([peaks()?, bends()?].join("\n\n"))
}

fn brightest(picture: &Picture) -> f64 {
    picture
        .attachments
        .iter()
        .flatten()
        .zip(&picture.covered)
        .filter(|(_, covered)| **covered)
        .fold(0.0, |most, (color, _)| f64::max(most, color[0]))
}

/// The highlight by the fineness of the mesh.
fn peaks() -> Result<String, String> {
    let mut text = String::from(
        "| mesh | at the vertices: peak | largest error | at the fragments, N interpolated: peak | largest error | N of length 1 \
         again: peak | largest error |\n| --- | --- | --- | --- | --- | --- | --- |",
    );
    let finest = Ball { size: SIZE, segments: 1024 };
    let truth = picture(&scene(Highlight::new(Place::Fragments, By::Squaring, EXPONENT), finest)?)?;
    for segments in SEGMENTS {
        let _ = write!(text, "\n| {segments}x{} |", segments / 2);
        for (at, renormalized) in [(Place::Vertices, true), (Place::Fragments, false), (Place::Fragments, true)] {
            let way = Highlight { renormalized, ..Highlight::new(at, By::Squaring, EXPONENT) };
            let drawn = picture(&scene(way, Ball { size: SIZE, segments })?)?;
            let _ = write!(text, " {:.3} | {:.1e} |", brightest(&drawn), errors(&drawn, &truth).0);
        }
    }
    Ok(text)
}

/// A square of two triangles that is turned about an upright axis, with a color at each corner.
fn square(degrees: u32, interpolation: &str) -> Result<Picture, String> {
    let vertex = format!(
        "#version 150\nin vec2 pv;\nuniform mat4 mc;\n{interpolation} out float s;\n\
         void main()\n{{\n    s = 0.5 * pv.y + 0.5;\n    gl_Position = mc * vec4(pv, 0.0, 1.0);\n}}\n"
    );
    let fragment = format!(
        "#version 150\n{interpolation} in float s;\nout vec4 color;\nvoid main()\n{{\n    color = vec4(vec3(s), 1.0);\n}}\n"
    );
    let text = format!(
        "[framebuffer]\nwidth = {SIZE}\nheight = {SIZE}\n[camera]\neye = [0.0, 0.0, 3.0]\nfovy = 50\nnear = 0.1\n[[draw]]\n\
         vertex = \"a.vert\"\nfragment = \"a.frag\"\ntransform = {{ rotate = [0.0, {degrees}, 0.0] }}\n[draw.attributes]\n\
         pv = {{ size = 2, values = [-1, -1, 1, -1, 1, 1, -1, -1, 1, 1, -1, 1] }}\n[draw.matrices]\n\
         mc = \"model_view_projection\"\n"
    );
    picture(&loaded(&text, MemoryFiles::new([("a.vert", vertex.as_str()), ("a.frag", fragment.as_str())]))?)
}

/// The largest change of the slope along a row: where a straight ramp has a bend.
fn bend(picture: &Picture) -> f64 {
    let width = picture.width as usize;
    let colors = picture.attachments.first().map_or(&[][..], Vec::as_slice);
    let rows = colors.chunks(width).zip(picture.covered.chunks(width));
    let inner = rows.flat_map(|(row, covered)| {
        row.windows(3).zip(covered.windows(3)).filter_map(|(colors, covered)| {
            let all = covered.iter().all(|covered| *covered);
            all.then(|| (colors[0][0] - 2.0 * colors[1][0] + colors[2][0]).abs())
        })
    });
    inner.fold(0.0, f64::max)
}

/// The error of interpolation without perspective, by the angle of the square.
fn bends() -> Result<String, String> {
    let mut text = String::from(
        "| square turned by | without perspective: largest error | jump of the slope | with perspective: jump of the slope |\n\
         | --- | --- | --- | --- |",
    );
    for degrees in [0, 15, 30, 45, 60, 75] {
        let (right, bent) = (square(degrees, "smooth")?, square(degrees, "noperspective")?);
        let error = errors(&bent, &right).0;
        let _ = write!(text, "\n| {degrees} degrees | {error:.1e} | {:.1e} | {:.1e} |", bend(&bent), bend(&right));
    }
    Ok(text)
}

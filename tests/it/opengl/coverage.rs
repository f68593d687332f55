//! Compares the coverage of the reference with the OpenGL driver's, fragment by fragment, on random primitives: those
//! of `raster`, except that lines follow OpenGL's own rule.

use crate::raster::{Random, SIDE, Vertex, at, scene};
use glisten::scene::Scene;
use glisten_reference::{LineRule, Precision, RenderOptions};
use glisten_scene::picture::Picture;

/// The driver's picture and the reference's; `None` without a driver.
fn both(scene: &Scene) -> Option<[Picture; 2]> {
    let gl = super::gl()?;
    let options = RenderOptions {
        precision: Precision::F32,
        lines: LineRule::OpenGl,
        mark_edges: false,
        ..RenderOptions::default()
    };
    let reference = glisten_reference::render(scene, &options).expect("the reference draws");
    Some([gl.render(scene).unwrap_or_else(|error| panic!("{error}")), reference])
}

/// The pixels that differ, and the number of fragments that the reference has drawn.
fn differing([drawn, reference]: &[Picture; 2]) -> (Vec<usize>, usize) {
    let (drawn, reference) = (&drawn.attachments[0], &reference.attachments[0]);
    let pixels = (0..SIDE * SIDE).filter(|&pixel| drawn[pixel] != reference[pixel]).collect();
    let fragments = reference.iter().map(|pixel| pixel[0] as usize).sum();
    assert!(fragments > 400, "only {fragments} fragments");
    (pixels, fragments)
}

/// OpenGL counts rows from the bottom, so a position may be rounded differently before it is snapped.
#[test]
fn triangles() {
    let mut random = Random(11);
    let side = SIDE as f64;
    for (count, clipped) in [(2000, false), (300, true)] {
        let vertices: Vec<Vertex> = (0..3 * count)
            .map(|index| {
                let reach = [2.0, 8.0, 40.0, 90.0][index / 3 % 4];
                let (low, high) = if clipped { (-side, 2.0 * side) } else { (reach, side - reach) };
                let w = if clipped { random.within(-0.5, 2.0) } else { random.within(0.5, 4.0) };
                at(random.within(low, high), random.within(low, high), w)
            })
            .collect();
        let Some(pictures) = both(&scene("triangles", &vertices, 3, None)) else { return };
        let (pixels, fragments) = differing(&pictures);
        println!("{count} triangles, clipped: {clipped}: {} pixels differ among {fragments} fragments", pixels.len());
        assert!(pixels.len() * 100_000 <= fragments, "{pixels:?}");
    }
}

/// The driver decides, row by row, on which side an edge of a point is that is snapped to the centers of pixels.
#[test]
fn points() {
    let mut random = Random(12);
    let side = SIDE as f64;
    let vertices: Vec<Vertex> =
        (0..3000).map(|_| at(random.within(0.0, side), random.within(0.0, side), random.within(0.5, 4.0))).collect();
    let sizes: Vec<f64> = (0..3000).map(|_| random.within(0.25, 12.0)).collect();
    let Some(pictures) = both(&scene("points", &vertices, 1, Some(&sizes))) else { return };
    let (pixels, fragments) = differing(&pictures);
    println!("3000 points: {} pixels differ among {fragments} fragments", pixels.len());
    assert!(pixels.len() * 200 <= fragments, "{pixels:?}");
}

/// Each line is in a cell of its own. A driver's fragments may be off by one in x or y (OpenGL 3.2, section 3.5.1).
#[test]
fn lines() {
    const CELL: usize = 24;
    let mut random = Random(13);
    let cells = SIDE / CELL;
    let (mut off, mut drawn) = (0, 0);
    for _ in 0..20 {
        let vertices: Vec<Vertex> = (0..2 * cells * cells)
            .map(|index| {
                let corner = |number: usize| (number * CELL) as f64;
                let (x, y) = (corner(index / 2 % cells), corner(index / 2 / cells));
                let mut inside = |from: f64| from + random.within(2.0, CELL as f64 - 2.0);
                at(inside(x), inside(y), 1.0)
            })
            .collect();
        let Some(pictures) = both(&scene("lines", &vertices, 2, None)) else { return };
        let (pixels, fragments) = differing(&pictures);
        let [ours, theirs] = &pictures;
        for &pixel in &pixels {
            let other = if ours.covered[pixel] { theirs } else { ours };
            let (x, y) = (pixel % SIDE, pixel / SIDE);
            let near = (y - 1..=y + 1).any(|y| (x - 1..=x + 1).any(|x| other.covered[y * SIDE + x]));
            assert!(near, "the fragment at ({x}, {y}) is more than a pixel away from the line");
        }
        (off, drawn) = (off + pixels.len(), drawn + fragments);
    }
    println!("1280 lines by OpenGL's rule: {off} pixels differ among {drawn} fragments, each at most one pixel off");
    assert!(off * 200 <= drawn, "{off} of {drawn}");
}

//! Compares the coverage of the CPU reference with lavapipe's, fragment by fragment, on random primitives.
//!
//! Every fragment adds 1 and its primitive's number to the picture, so that a fragment that only one side draws is
//! visible, wherever it is and whatever else is drawn there. The tests need a Vulkan software adapter.

use crate::drawing::from_disk;
use crate::scenes;
use crate::support::compiler;
use glisten::scene::{DiskFiles, MemoryFiles, Scene, load};
use glisten_gpu::{Gpu, Via};
use glisten_reference::domain::faults::{Faults, KNOWN};
use glisten_reference::{LineRule, Precision, RenderOptions};
use glisten_scene::compare::{Criterion, Verdict};
use glisten_scene::picture::Picture;

const VERTEX: &str = "#version 150\nin vec4 p;\nin float id;\nin float size;\nflat out float v;\n\
    void main() { v = id; gl_Position = p; gl_PointSize = size; }\n";
const FRAGMENT: &str = "#version 150\nflat in float v;\nout vec4 fc;\nvoid main() { fc = vec4(1.0, v, 0.0, 0.0); }\n";
pub(crate) const SIDE: usize = 192;

/// Random numbers from a seed, the same in every run.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f64 / (1_u64 << 24) as f64
    }

    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + self.unit() * (high - low)
    }
}

pub(crate) type Vertex = [f64; 4];

/// The clip coordinates of a window position in pixels from the lower left, with depth 0.
pub(crate) fn at(x: f64, y: f64, w: f64) -> Vertex {
    let ndc = |pixels: f64| pixels / SIDE as f64 * 2.0 - 1.0;
    [ndc(x) * w, ndc(y) * w, 0.0, w]
}

pub(crate) fn scene(primitive: &str, vertices: &[Vertex], each: usize, sizes: Option<&[f64]>) -> Scene {
    let positions: Vec<String> = vertices.iter().flatten().map(|value| format!("{:e}", *value as f32)).collect();
    let ids: Vec<String> = (0..vertices.len()).map(|index| format!("{}.0", index / each % 97)).collect();
    let sizes: Vec<String> =
        (0..vertices.len()).map(|index| format!("{:e}", sizes.map_or(1.0, |sizes| sizes[index]))).collect();
    let text = format!(
        "framebuffer = {{ width = {SIDE}, height = {SIDE}, clear = [0, 0, 0, 0] }}\n[[draw]]\nvertex = \"a.vert\"\n\
         fragment = \"a.frag\"\nprimitive = \"{primitive}\"\nblend = \"add\"\nprogram_point_size = true\n\
         [draw.attributes]\np = {{ size = 4, values = [{}] }}\nid = {{ size = 1, values = [{}] }}\n\
         size = {{ size = 1, values = [{}] }}\n",
        positions.join(","),
        ids.join(","),
        sizes.join(",")
    );
    let files = MemoryFiles::new([("a.toml", text.as_str()), ("a.vert", VERTEX), ("a.frag", FRAGMENT)]);
    let loaded = load("a.toml", &files, &compiler());
    let messages: Vec<&String> = loaded.diagnostics.iter().map(|diagnostic| &diagnostic.message).collect();
    loaded.scene.unwrap_or_else(|| panic!("{messages:?}"))
}

/// The number of fragments, and of pixels in which the two sides differ.
struct Count {
    fragments: usize,
    differing: Vec<(usize, usize)>,
}

fn count(scene: &Scene) -> Count {
    let gpu =
        Gpu::new(Some("software")).expect("this test needs Mesa's Vulkan driver: apt-get install mesa-vulkan-drivers");
    let drawn = gpu.render(scene, Via::Spirv).expect("the scene draws").picture;
    let options = RenderOptions {
        precision: Precision::F32,
        lines: LineRule::Vulkan,
        mark_edges: false,
        ..RenderOptions::default()
    };
    let reference = glisten_reference::render(scene, &options).expect("the reference draws");
    let (drawn, reference) = (&drawn.attachments[0], &reference.attachments[0]);
    let differing =
        (0..SIDE * SIDE).filter(|&pixel| drawn[pixel] != reference[pixel]).map(|pixel| (pixel % SIDE, pixel / SIDE));
    Count { fragments: reference.iter().map(|pixel| pixel[0] as usize).sum(), differing: differing.collect() }
}

#[track_caller]
fn assert_few(found: &Count, allowed: usize) {
    let differing = found.differing.len();
    assert!(found.fragments > 1000, "only {} fragments", found.fragments);
    assert!(
        differing <= allowed,
        "{differing} pixels differ among {} fragments: {:?}",
        found.fragments,
        found.differing.iter().take(8).collect::<Vec<_>>()
    );
}

fn side() -> f64 {
    SIDE as f64
}

#[test]
fn triangles_inside_the_window() {
    let mut random = Random(1);
    let vertices: Vec<Vertex> = (0..3 * 4000)
        .map(|index| {
            // From specks to the size of the whole window.
            let reach = [2.0, 8.0, 40.0, 90.0][index / 3 % 4];
            let (x, y) = (random.within(reach, side() - reach), random.within(reach, side() - reach));
            at(x, y, random.within(0.5, 4.0))
        })
        .collect();
    assert_few(&count(&scene("triangles", &vertices, 3, None)), 0);
}

/// The share of a triangle's pixels whose centers are within 1/128 pixel of its edges, which a comparison omits.
#[test]
fn few_pixels_are_near_an_edge() {
    let mut random = Random(9);
    let (mut near, mut covered) = (0, 0);
    for _ in 0..60 {
        let vertices: Vec<Vertex> =
            (0..3).map(|_| at(random.within(0.0, side()), random.within(0.0, side()), 1.0)).collect();
        let options = RenderOptions {
            precision: Precision::F32,
            lines: LineRule::Vulkan,
            mark_edges: true,
            ..RenderOptions::default()
        };
        let picture = glisten_reference::render(&scene("triangles", &vertices, 3, None), &options).expect("it draws");
        near += picture.near_edge.iter().filter(|near| **near).count();
        covered += picture.covered.iter().filter(|covered| **covered).count();
    }
    let share = near as f64 / covered as f64;
    // 1/64 pixel on both sides of a circumference of some three hundred pixels, for an area of some three thousand.
    assert!(covered > 60_000 && share < 2e-3, "{near} of {covered}: {share}");
}

#[test]
fn slivers() {
    let mut random = Random(2);
    let mut vertices = Vec::new();
    for index in 0..3000 {
        let width = [1.0, 0.25, 0.03, 0.004][index % 4];
        let (a, b) = (
            (random.within(4.0, 188.0), random.within(4.0, 188.0)),
            (random.within(4.0, 188.0), random.within(4.0, 188.0)),
        );
        let c = (b.0 + random.within(-width, width), b.1 + random.within(-width, width));
        vertices.extend([a, b, c].map(|(x, y)| at(x, y, 1.0)));
    }
    assert_few(&count(&scene("triangles", &vertices, 3, None)), 0);
}

#[test]
fn shared_edges_are_drawn_once() {
    // A grid of jittered corners that extends past the window on all sides.
    let mut random = Random(3);
    let cells = 36;
    let step = (side() + 20.0) / f64::from(cells);
    let corners: Vec<(f64, f64)> = (0..=cells * (cells + 2))
        .map(|index| {
            let (column, row) = (f64::from(index % (cells + 1)), f64::from(index / (cells + 1)));
            let jitter = step * 0.2;
            (column * step - 10.0 + random.within(-jitter, jitter), row * step - 10.0 + random.within(-jitter, jitter))
        })
        .collect();
    let mut vertices = Vec::new();
    for row in 0..cells {
        for column in 0..cells {
            let first = (row * (cells + 1) + column) as usize;
            let [a, b, c, d] =
                [first, first + 1, first + cells as usize + 1, first + cells as usize + 2].map(|i| corners[i]);
            vertices.extend([a, b, d, a, d, c].map(|(x, y)| at(x, y, 1.0)));
        }
    }
    let scene = scene("triangles", &vertices, 3, None);
    let options = RenderOptions {
        precision: Precision::F64,
        lines: LineRule::OpenGl,
        mark_edges: false,
        ..RenderOptions::default()
    };
    let picture = glisten_reference::render(&scene, &options).expect("the reference draws");
    // Clipping adds corners on the border of the window; inside it, every pixel is drawn exactly once.
    let wrong = (0..SIDE * SIDE).filter(|&pixel| picture.attachments[0][pixel][0] != 1.0).count();
    assert_eq!(wrong, 0);
    assert_few(&count(&scene), 0);
}

#[test]
fn clipped_triangles() {
    let mut random = Random(4);
    let mut vertices = Vec::new();
    for _ in 0..3000 {
        for _ in 0..3 {
            // Through the sides, the near and the far plane, and behind the eye.
            let w = random.within(-1.0, 3.0);
            vertices.push([random.within(-4.0, 4.0), random.within(-4.0, 4.0), random.within(-3.0, 3.0), w]);
        }
    }
    // Four of ten million: the driver's z in the target's clip space, rounded differently, cuts an edge slightly
    // elsewhere.
    assert_few(&count(&scene("triangles", &vertices, 3, None)), 8);
}

#[test]
fn a_triangle_far_past_the_window_covers_all_of_it() {
    // In f32 a cut of such an edge is off by more than the window's width, and drivers draw a part of it or nothing.
    for reach in [1e4, 1e6, 1e8, 1e12] {
        let corners: [Vertex; 3] =
            [[-1.0, -1.0], [1.0, -0.3], [0.01, 2.0]].map(|[x, y]| [x * reach, y * reach, 0.0, 1.0]);
        let options = RenderOptions {
            precision: Precision::F64,
            lines: LineRule::OpenGl,
            mark_edges: false,
            ..RenderOptions::default()
        };
        let picture = glisten_reference::render(&scene("triangles", &corners, 3, None), &options).expect("it draws");
        assert!(picture.covered.iter().all(|covered| *covered), "{reach:e}");
        // The result consists of two triangles, and nothing overlaps after clipping.
        assert!(picture.attachments[0].iter().all(|pixel| pixel[0] == 1.0), "{reach:e}");
    }
}

#[test]
fn points_of_all_sizes() {
    let mut random = Random(5);
    let vertices: Vec<Vertex> =
        (0..2000).map(|_| at(random.within(12.0, 180.0), random.within(12.0, 180.0), 1.0)).collect();
    let sizes: Vec<f64> = (0..2000).map(|index| [1.0, 1.5, 3.25, 8.0, 0.25][index % 5]).collect();
    assert_few(&count(&scene("points", &vertices, 1, Some(&sizes))), 0);
}

#[test]
fn points_whose_centers_lie_outside() {
    let mut random = Random(7);
    let vertices: Vec<Vertex> =
        (0..1500).map(|_| at(random.within(-8.0, side() + 8.0), random.within(-8.0, side() + 8.0), 1.0)).collect();
    let sizes = vec![9.0; 1500];
    let outer = scene("points", &vertices, 1, Some(&sizes));
    assert_few(&count(&outer), 0);
    // OpenGL discards them: the picture is that of only the points inside.
    let inside: Vec<Vertex> = vertices.into_iter().filter(|[x, y, ..]| x.abs() <= 1.0 && y.abs() <= 1.0).collect();
    let options = RenderOptions {
        precision: Precision::F32,
        lines: LineRule::OpenGl,
        mark_edges: false,
        ..RenderOptions::default()
    };
    let fragments = |scene: &Scene| -> f64 {
        let picture = glisten_reference::render(scene, &options).expect("the reference draws");
        picture.attachments[0].iter().map(|pixel| pixel[0]).sum()
    };
    let inner = scene("points", &inside, 1, Some(&sizes));
    assert!(inside.len() < 1400);
    assert_eq!(fragments(&outer), fragments(&inner));
}

#[test]
fn clipped_lines() {
    let mut random = Random(8);
    let vertices: Vec<Vertex> = (0..2 * 1000)
        .map(|_| {
            let w = random.within(-0.5, 3.0);
            [random.within(-3.0, 3.0), random.within(-3.0, 3.0), random.within(-3.0, 3.0), w]
        })
        .collect();
    assert_few(&count(&scene("lines", &vertices, 2, None)), 0);
}

#[test]
fn lines_by_the_rule_of_vulkan() {
    let mut random = Random(6);
    let vertices: Vec<Vertex> = (0..2 * 1000)
        .map(|index| {
            let reach = if index / 2 % 2 == 0 { 190.0 } else { 20.0 };
            at(random.within(1.0, reach), random.within(1.0, reach), 1.0)
        })
        .collect();
    assert_few(&count(&scene("lines", &vertices, 2, None)), 0);
}

#[test]
fn every_scene_of_the_repository_agrees_with_lavapipe() {
    let gpu =
        Gpu::new(Some("software")).expect("this test needs Mesa's Vulkan driver: apt-get install mesa-vulkan-drivers");
    let options = RenderOptions {
        precision: Precision::Envelope,
        lines: LineRule::Vulkan,
        mark_edges: true,
        ..RenderOptions::default()
    };
    let mut failures = Vec::new();
    let mut excused = Vec::new();
    for path in scenes::paths() {
        let loaded = load(&path, &DiskFiles, &compiler());
        let mut scene = loaded.scene.expect("another test loads it");
        // Large scenes are scaled down: the rules are the same.
        scene.framebuffer.width = scene.framebuffer.width.min(64);
        scene.framebuffer.height = scene.framebuffer.height.min(64);
        let reference = match glisten_reference::render(&scene, &options) {
            Ok(picture) => picture,
            Err(found) => {
                failures.push(format!("{path}: {found:?}"));
                continue;
            }
        };
        // WGSL's points are one pixel wide.
        let sized = scene.draws.iter().any(|draw| draw.state.program_point_size);
        for via in if sized { &[Via::Spirv][..] } else { &[Via::Spirv, Via::Wgsl] } {
            match gpu.render(&scene, *via) {
                Ok(rendered) => {
                    let mut verdict = Verdict::new(&rendered.picture, &reference, Criterion::Envelope);
                    if verdict.needs_excuse() {
                        verdict =
                            Verdict::excusing(&rendered.picture, &reference, Criterion::Envelope, &faulty(&scene));
                        excused.extend(verdict.known_faults.iter().map(|count| (path.clone(), count.fault)));
                    }
                    if verdict.fails() {
                        failures.push(format!("{path} by {}: {verdict:?}", via.name()));
                    }
                }
                Err(error) => failures.push(format!("{path} by {}: {error}", via.name())),
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    excused.sort_unstable();
    excused.dedup();
    let excused: Vec<(&str, &str)> =
        excused.iter().map(|(path, fault)| (path.rsplit('/').next().unwrap_or_default(), *fault)).collect();
    let known = [("behind_the_eye_noperspective.toml", "clipped_noperspective")];
    assert_eq!(excused, known, "what only a known fault explains");
}

/// The reference pictures with each known fault of the driver excused.
fn faulty(scene: &Scene) -> Vec<(&'static str, Picture)> {
    let draw = |faults: Faults| {
        let precision = Precision::Envelope;
        let options = RenderOptions { precision, lines: LineRule::Vulkan, faults, ..RenderOptions::default() };
        glisten_reference::render(scene, &options).expect("the reference draws")
    };
    KNOWN.iter().map(|known| (known.name, draw(Faults::only(known.fault)))).collect()
}

#[test]
fn an_endless_loop_is_told_where_it_stands() {
    let text = "framebuffer = { width = 512, height = 512 }\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
                vertex_count = 3\ninstances = 100000\n";
    let vertex = "#version 150\nvoid main() {\n@\ngl_Position = vec4(float(gl_VertexID) * 4.0 - 2.0, gl_VertexID == 1 ? \
                  4.0 : -1.0, 0.0, 1.0);\n}\n";
    let fragment = "#version 150\nout vec4 o;\nvoid main() {\no = vec4(0);\n@\n}\n";
    for (in_vertex, in_fragment, file, line) in [("for (;;) {}", "", "a.vert", 3), ("", "for (;;) {}", "a.frag", 5)] {
        let (vertex, fragment) = (vertex.replace('@', in_vertex), fragment.replace('@', in_fragment));
        let files = MemoryFiles::new([("a.toml", text), ("a.vert", &vertex), ("a.frag", &fragment)]);
        let loaded = load("a.toml", &files, &compiler());
        let options = RenderOptions { mark_edges: false, ..RenderOptions::default() };
        // If each instance or each pixel had a budget of its own, this would take more than a day.
        let errors = glisten_reference::render(&loaded.scene.expect("it loads"), &options).expect_err("it has no end");
        let place = loaded.sources.location(errors[0].primary.span).expect("it is in a file");
        assert_eq!((errors[0].code.id, errors.len()), ("E0913", 1));
        assert_eq!((loaded.sources.file(place.file).name(), place.line), (file, line));
    }
}

#[test]
fn noperspective_is_linear_in_the_window_behind_the_eye_too() {
    let scene = from_disk("fixtures/scenes/core/behind_the_eye_noperspective.toml");
    let options = RenderOptions {
        precision: Precision::F64,
        lines: LineRule::OpenGl,
        mark_edges: false,
        ..RenderOptions::default()
    };
    let picture = glisten_reference::render(&scene, &options).expect("the reference draws");
    // The corners of the scene after the division by w; the first is behind the eye. Red is 1 there, green and blue
    // at the other corners.
    let corners = [(1.8, 1.2), (2.5 / 1.7, -1.1 / 1.7), (-0.3 / 2.1, 1.9 / 2.1)];
    let (u, v) = (
        (corners[1].0 - corners[0].0, corners[1].1 - corners[0].1),
        (corners[2].0 - corners[0].0, corners[2].1 - corners[0].1),
    );
    let mut covered = 0;
    for pixel in (0..64 * 48).filter(|&pixel| picture.covered[pixel]) {
        let x = (pixel % 64) as f64 / 32.0 + 1.0 / 64.0 - 1.0 - corners[0].0;
        let y = 1.0 - (pixel / 64) as f64 / 24.0 - 1.0 / 48.0 - corners[0].1;
        let determinant = u.0 * v.1 - v.0 * u.1;
        let (s, t) = ((x * v.1 - y * v.0) / determinant, (y * u.0 - x * u.1) / determinant);
        let found = picture.attachments[0][pixel];
        // The scene's numbers are rounded to f32.
        for (channel, expected) in [1.0 - s - t, s, t].into_iter().enumerate() {
            assert!((found[channel] - expected).abs() < 1e-6, "pixel {pixel}: {found:?}");
        }
        covered += 1;
    }
    assert!(covered > 1000, "{covered}");
}

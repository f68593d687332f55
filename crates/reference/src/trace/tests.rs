//! Known programs: each value is that of the text, in order.

use super::{Component, Fate, Invocation, NoteKind, Place, Trace, trace};
use crate::stability::tests::scene_with;
use crate::{Precision, RenderOptions, render};
use glisten_front::source::SourceMap;
use glisten_scene::{Format, Scene};

const VERTEX: &str = "#version 150\nin vec2 p;\nout vec2 at;\n\
    void main() { vec2 half_way = p * 0.5; at = p; gl_Position = vec4(p, half_way.x, 1.0); }\n";

fn scene_of(body: &str, more: &str) -> (Scene, SourceMap) {
    scene_with(VERTEX, body, more)
}

fn at(scene: &Scene, place: Place) -> Trace {
    trace(scene, place).unwrap_or_else(|found| panic!("{found:?}"))
}

/// The values of a kind with the text of each: numbers to three digits.
fn told(invocation: &Invocation, sources: &SourceMap, kind: NoteKind) -> Vec<String> {
    let of_kind = invocation.entries.iter().filter(|entry| entry.kind == kind);
    let number = |scalar: &Component| match *scalar {
        Component::Float { single, .. } => format!("{single:.3}"),
        Component::Int(value) => value.to_string(),
        Component::Uint(value) | Component::Sampler(value) => value.to_string(),
        Component::Bool(value) => value.to_string(),
    };
    let text = |entry: &super::Entry| {
        let numbers: Vec<String> = entry.scalars.iter().map(number).collect();
        format!("{} {}", sources.snippet(entry.span), numbers.join(" "))
    };
    of_kind.map(text).collect()
}

fn single(component: &Component) -> f64 {
    let Component::Float { single, .. } = component else { panic!("{component:?}") };
    *single
}

#[test]
fn every_expression_has_its_value_in_order() {
    let body = "float twice(float x) { return x * 2.0; }\n\
        void main() { vec2 q = at * 4.0; float t = twice(q.x) + 1.0; int n = int(t); o = vec4(q, t, n > 0 ? 1.0 : 0.5); }";
    let (scene, sources) = scene_of(body, "");
    let found = at(&scene, Place::Pixel([12, 4]));
    assert_eq!(found.invocations.len(), 1);
    let one = &found.invocations[0];
    assert_eq!(told(one, &sources, NoteKind::Input), ["at 0.562 0.438"]);
    let values = [
        "at * 4.0 2.250 1.750",
        "x * 2.0 4.500",
        "twice(q.x) 4.500",
        "twice(q.x) + 1.0 5.500",
        "int(t) 5",
        "n > 0 true",
        "n > 0 ? 1.0 : 0.5 1.000",
        "vec4(q, t, n > 0 ? 1.0 : 0.5) 2.250 1.750 5.500 1.000",
        "o = vec4(q, t, n > 0 ? 1.0 : 0.5) 2.250 1.750 5.500 1.000",
    ];
    assert_eq!(told(one, &sources, NoteKind::Value), values);
    assert_eq!(told(one, &sources, NoteKind::Local), ["q 2.250 1.750", "x 2.250", "t 5.500", "n 5"]);
    assert_eq!(told(one, &sources, NoteKind::Output), ["o 2.250 1.750 5.500 1.000"]);
    let inside: Vec<usize> = one.entries.iter().map(|entry| entry.depth).collect();
    assert_eq!(inside.iter().max(), Some(&1), "the body of the function is one call deep");
    assert_eq!(inside.last(), Some(&0));
}

#[test]
fn only_the_way_that_was_taken_is_told() {
    let body = "void main() { float s = 0.0; for (int i = 0; i < 3; i++) { if (i == 1) continue; s += at.x; }\n\
        if (at.y > 0.0) s += 8.0; else s -= 8.0; o = at.x > 0.5 ? vec4(s + 1.0) : vec4(s - 1.0); }";
    let (scene, sources) = scene_of(body, "");
    let found = at(&scene, Place::Pixel([12, 4]));
    let one = &found.invocations[0];
    assert_eq!(told(one, &sources, NoteKind::Loop), ["i < 3 true", "i < 3 true", "i < 3 true", "i < 3 false"]);
    assert_eq!(told(one, &sources, NoteKind::If), ["i == 1 false", "i == 1 true", "i == 1 false", "at.y > 0.0 true"]);
    let values = told(one, &sources, NoteKind::Value);
    let sums: Vec<&String> = values.iter().filter(|told| told.starts_with("s ")).collect();
    assert_eq!(sums, ["s += at.x 0.562", "s += at.x 1.125", "s += 8.0 9.125", "s + 1.0 10.125"], "{values:?}");
}

#[test]
fn fragments_of_a_pixel_stand_in_order_with_their_fates() {
    let second = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nprimitive = \"triangles\"\ndepth_test = true\n[draw.attributes]\n\
        p = { size = 2, values = [-1, -1, 1, -1, -1, 1, -1, -1, 1, -1, -1, 1] }\n";
    let (scene, sources) =
        scene_of("void main() { if (gl_PrimitiveID == 1 && at.x < 0.0) discard; o = vec4(at, 0.0, 1.0); }", second);
    let found = at(&scene, Place::Pixel([3, 12]));
    let fates: Vec<(usize, Fate)> = found.invocations.iter().map(|one| (one.draw, one.fate)).collect();
    assert_eq!(fates, [(0, Fate::Done), (1, Fate::Done), (1, Fate::Discarded)]);
    assert_eq!(told(&found.invocations[2], &sources, NoteKind::Discard).len(), 1);
    assert_eq!(found.invocations[2].vertices, [3, 4, 5]);
    assert!(told(&found.invocations[2], &sources, NoteKind::Output).is_empty(), "it was discarded before");
}

#[test]
fn a_fragment_behind_another_fails() {
    let again = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nprimitive = \"triangle_strip\"\ndepth_test = true\n[draw.attributes]\n\
        p = { size = 2, values = [-1, -1, 1, -1, -1, 1, 1, 1] }\n";
    let (mut scene, _) = scene_of("void main() { o = vec4(at, 0.0, 1.0); }", again);
    scene.draws[0].state.depth_test = true;
    let fates: Vec<Fate> = at(&scene, Place::Pixel([3, 3])).invocations.iter().map(|one| one.fate).collect();
    assert_eq!(fates, [Fate::Done, Fate::Failed]);
}

#[test]
fn exact_values_and_intervals_are_there() {
    let (scene, sources) = scene_of("void main() { float c = 1.0 - cos(at.x * 1e-3); o = vec4(c * 1e6); }", "");
    let found = at(&scene, Place::Pixel([12, 4]));
    let lost =
        found.invocations[0].entries.iter().find(|entry| sources.snippet(entry.span) == "1.0 - cos(at.x * 1e-3)");
    let Some(Component::Float { single, exact, interval: Some(interval) }) =
        lost.and_then(|entry| entry.scalars.first())
    else {
        panic!("{lost:?}");
    };
    assert!((single - exact).abs() > 1e-8 && (*exact - 1.582e-7).abs() < 1e-10, "{single} {exact}");
    assert!(interval.low <= *single && *single <= interval.high, "{interval:?}");
}

#[test]
fn the_color_is_that_of_the_picture() {
    let body = "float wave(float x) { return x < 0.2 ? sin(x * 9.0) : x * x; }\nvoid main() { vec3 n = normalize(vec3(at, 0.4)); \
        float s = 0.0; for (int i = 0; i < 5; i++) { s += wave(n.x * float(i)); if (s > 2.0) break; } \
        o = vec4(s * 0.2, fwidth(s), n.z, 1.0); }";
    let (scene, _) = scene_of(body, "");
    let in_f32 = RenderOptions { precision: Precision::F32, ..RenderOptions::default() };
    let picture = render(&scene, &in_f32).unwrap_or_else(|found| panic!("{found:?}"));
    let mut compared = 0;
    for [x, y] in [[0, 0], [3, 9], [12, 4], [15, 15], [8, 7]] {
        let found = at(&scene, Place::Pixel([x, y]));
        let shown = picture.attachments[0][(y * 16 + x) as usize];
        for (channel, component) in found.colors[0].iter().enumerate() {
            let Component::Float { single, exact, interval: Some(interval) } = component else {
                panic!("{component:?}")
            };
            assert!((single - shown[channel]).abs() < 1e-2, "{x} {y}: {single} {}", shown[channel]);
            assert!(interval.low <= *exact && *exact <= interval.high, "{component:?}");
            compared += 1;
        }
        let outputs = found.invocations[0].entries.iter().filter(|entry| entry.kind == NoteKind::Output);
        let told: Vec<f64> = outputs.flat_map(|entry| &entry.scalars).map(single).collect();
        let drawn: Vec<f64> = found.colors[0].iter().map(single).collect();
        assert_eq!(told, drawn);
    }
    assert_eq!(compared, 20);
}

#[test]
fn a_vertex_has_its_attributes_and_outputs() {
    let (scene, sources) = scene_of("void main() { o = vec4(at, 0.0, 1.0); }", "");
    let found = at(&scene, Place::Vertex { draw: 0, vertex: 2, instance: 0 });
    assert_eq!(found.invocations.len(), 1);
    let one = &found.invocations[0];
    assert_eq!(told(one, &sources, NoteKind::Input), ["p -1.000 1.000"]);
    assert_eq!(told(one, &sources, NoteKind::Local), ["half_way -0.500 0.500"]);
    let outputs = told(one, &sources, NoteKind::Output);
    assert!(outputs.iter().any(|told| told.ends_with("-1.000 1.000 -0.500 1.000")), "{outputs:?}");
}

#[test]
fn a_place_that_is_not_there_is_refused() {
    let (scene, _) = scene_of("void main() { o = vec4(at, 0.0, 1.0); }", "");
    for place in [
        Place::Pixel([16, 0]),
        Place::Pixel([0, u32::MAX]),
        Place::Vertex { draw: 1, vertex: 0, instance: 0 },
        Place::Vertex { draw: 0, vertex: 4, instance: 0 },
        Place::Vertex { draw: 0, vertex: 0, instance: 1 },
    ] {
        assert!(trace(&scene, place).is_err(), "{place:?}");
    }
}

#[test]
fn colors_are_stored_between_draws_that_blend() {
    let second = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nprimitive = \"triangles\"\nblend = \"add\"\n[draw.attributes]\n\
        p = { size = 2, values = [-1, -1, 1, -1, -1, 1] }\n";
    let (mut scene, _) = scene_of("void main() { o = vec4(1.5, -0.5, 0.3, at.y); }", second);
    scene.framebuffer.format = Format::Rgba8Unorm;
    let found = at(&scene, Place::Pixel([3, 12]));
    let colors: Vec<f64> = found.colors[0].iter().map(single).collect();
    let options = RenderOptions { precision: Precision::F32, ..RenderOptions::default() };
    let picture = render(&scene, &options).expect("it draws");
    let index = 12 * scene.framebuffer.width as usize + 3;
    assert_eq!(colors, picture.attachments[0][index]);
    assert_eq!(colors[..2], [1.0, 0.0]);
}

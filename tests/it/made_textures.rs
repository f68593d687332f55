//! Textures that a scene makes: what a light sees of its meshes, and profiles of lamps.

use crate::support::compiler;
use glisten::library::Embedded;
use glisten::scene::{Loaded, MemoryFiles, Scene, load};
use glisten_verify::scene::{Texels, Texture};

const FRAGMENT: &str = "#version 150
uniform sampler2D map;
uniform mat4 to_map;
in vec3 world;
out vec4 color;
void main()
{
    vec3 place = (to_map * vec4(world, 1.0)).xyz;
    color = vec4(place, texture(map, place.xy).r);
}";
const VERTEX: &str = "#version 150
in vec3 position;
uniform mat4 model, model_view_projection;
out vec3 world;
void main()
{
    world = (model * vec4(position, 1.0)).xyz;
    gl_Position = model_view_projection * vec4(position, 1.0);
}";
const MATRICES: &str = "matrices = { model = \"model\", model_view_projection = \"model_view_projection\" }";
/// A floor, and a smaller plate above it.
const DEPTHS: &str =
    "depths = { camera = { eye = [0, 4, 0], up = [0, 0, 1], ortho = 2, near = 1, far = 5 }, matrix = \"to_map\" }";

fn scene(map: &str) -> String {
    let draw = |height: f64, size: f64| {
        format!(
            "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\ndepth_test = true\n{MATRICES}\n\
             mesh = {{ shape = \"plane\", size = {size} }}\ntransform = {{ translate = [0, {height}, 0] }}\n\
             textures = {{ map = {{ {map} }} }}\n"
        )
    };
    let camera = "[framebuffer]\nwidth = 32\nheight = 32\n[camera]\neye = [0, 4, 0]\nup = [0, 0, 1]\northo = 2\nnear = 1\nfar = 5\n";
    camera.to_owned() + &draw(0.0, 4.0) + &draw(2.0, 2.0)
}

fn loaded(text: &str, more: &[(&str, &str)]) -> Loaded {
    let files = [("s.toml", text), ("a.vert", VERTEX), ("a.frag", FRAGMENT)];
    let files = MemoryFiles::new(files.into_iter().chain(more.iter().copied()));
    load("s.toml", &files, &compiler().with_includes(Embedded))
}

fn good(text: &str) -> Scene {
    let loaded = loaded(text, &[]);
    let told: Vec<&str> = loaded.diagnostics.iter().map(|found| found.message.as_str()).collect();
    assert!(told.is_empty(), "{told:?}");
    loaded.scene.expect("it is good")
}

fn first_error(text: &str, more: &[(&str, &str)]) -> String {
    let loaded = loaded(text, more);
    assert!(loaded.scene.is_none(), "{text}");
    loaded.diagnostics.iter().find(|found| found.is_error()).map(|found| found.message.clone()).unwrap_or_default()
}

fn texels(texture: &Texture, level: usize) -> &[[f32; 4]] {
    let Some(Texels::Float(texels)) = texture.levels.get(level).map(|level| &level.texels) else { panic!("floats") };
    texels
}

/// The camera of the map is that of the picture, so the map has what the picture shows: the depths of the nearest surfaces.
#[test]
fn a_map_has_the_depths_that_a_picture_from_its_place_shows() {
    let scene = good(&scene(&format!(
        "{DEPTHS}, width = 32, height = 32, mipmaps = true, filter = \"trilinear\", wrap = \"clamp\""
    )));
    let picture = glisten_reference::render(&scene, &glisten_reference::RenderOptions::default()).expect("it draws");
    let map = scene.draws[0].textures[0].as_ref().expect("it has a map");
    assert_eq!((map.levels.len(), texels(map, 0).len()), (6, 1024));
    let mut heights = std::collections::BTreeSet::new();
    for (texel, color) in texels(map, 0).iter().zip(&picture.attachments[0]) {
        assert!((f64::from(texel[0]) - color[2]).abs() < 1e-6, "{texel:?} {color:?}");
        assert!((f64::from(texel[0]) - color[3]).abs() < 1e-6, "{texel:?} {color:?}");
        let d = texel[0] - 0.5;
        assert_eq!(texel[1..], [d, d * d, 1.0]);
        heights.insert((texel[0] * 4.0).round() as i32);
    }
    assert_eq!(heights.into_iter().collect::<Vec<_>>(), [1, 3]);
    // The moments of the last level are means: three quarters are floor.
    let [depth, first, second, _] = texels(map, 5)[0];
    assert!((depth - 0.625).abs() < 1e-6 && (first - 0.125).abs() < 1e-6 && (second - 0.0625).abs() < 1e-6);
}

#[test]
fn a_map_sees_the_draws_that_it_names() {
    let only = DEPTHS.replace("matrix", "draws = [0], matrix");
    let scene = good(&scene(&format!("{only}, width = 16, height = 8")));
    let map = scene.draws[1].textures[0].as_ref().expect("it has a map");
    assert_eq!(texels(map, 0).len(), 128);
    // The camera is twice as wide as the floor, by the aspect of the map.
    let floor = texels(map, 0).iter().filter(|texel| (texel[0] - 0.75).abs() < 1e-6).count();
    assert_eq!((floor, texels(map, 0).iter().filter(|texel| texel[0] == 1.0).count()), (64, 64));
}

#[test]
fn what_is_wrong_with_a_map_is_told() {
    for (map, expected) in [
        (DEPTHS.replace("matrix", "draws = [2], matrix"), "the scene has no draw 2 with a mesh"),
        (DEPTHS.replace("matrix", "draws = [-1], matrix"), "a draw has a number from 0 on"),
        (DEPTHS.replace("to_map", "model"), ""),
        ("depths = { matrix = \"to_map\" }".to_owned(), "a map of depths has a `camera`"),
        (DEPTHS.replace("to_map", "map"), "`map` is a sampler"),
        (DEPTHS.replace("matrix", "shows"), "a map of depths has no key `shows`"),
        (format!("{DEPTHS}, pattern = \"sky\""), "a texture with `pattern` has no `depths`"),
        (format!("{DEPTHS}, width = 5000"), "`width`"),
    ] {
        let text = scene(&map);
        if expected.is_empty() {
            assert!(loaded(&text, &[]).scene.is_some(), "{map}");
            continue;
        }
        let told = first_error(&text, &[]);
        assert!(told.contains(expected), "{map}: {told}");
    }
}

const DOWNLIGHT: &str = include_str!("../../fixtures/profiles/downlight.ies");
const WINGS: &str = include_str!("../../fixtures/profiles/wings.ies");

fn lit(profile: &str) -> String {
    scene(profile)
}

#[test]
fn a_profile_has_the_candela_of_its_file_by_the_angle() {
    for (keys, files, at, expected) in [
        ("ies = \"a.ies\"", DOWNLIGHT, 0, 1250.0),
        ("ies = \"a.ies\"", DOWNLIGHT, 25, 862.0),
        ("ies = \"a.ies\"", DOWNLIGHT, 27, 862.0 + 0.4 * (704.0 - 862.0)),
        ("ies = \"a.ies\"", DOWNLIGHT, 91, 0.0),
        ("ies = \"a.ies\"", WINGS, 45, 520.0 * 1.5 * 0.9),
        ("ies = \"a.ies\", width = 19", WINGS, 3, 480.0 * 1.5 * 0.9),
    ] {
        let text = lit(&format!("{keys}, filter = \"linear\""))
            .replace("[[draw]]", "[[draw]]\nuniforms = { to_map = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1] }");
        let loaded = loaded(&text, &[("a.ies", files)]);
        let told: Vec<&str> = loaded.diagnostics.iter().map(|found| found.message.as_str()).collect();
        let scene = loaded.scene.unwrap_or_else(|| panic!("{told:?}"));
        let texture = scene.draws[0].textures[0].as_ref().expect("it has a profile");
        let [candela, ..] = texels(texture, 0)[at];
        assert!((f64::from(candela) - expected).abs() < 1e-3, "{keys} {at}: {candela} for {expected}");
    }
}

/// With `lumen`, all of the light is as much as the scene says: by the sum over the texels.
#[test]
fn lumen_scale_a_profile() {
    let text = lit("ies = \"a.ies\", lumen = 800, width = 1801");
    let scene = loaded(&text, &[("a.ies", DOWNLIGHT)]).scene.expect("it is good");
    let texture = scene.draws[0].textures[0].as_ref().expect("it has a profile");
    let step = std::f64::consts::PI / 1800.0;
    let part = |(at, texel): (usize, &[f32; 4])| f64::from(texel[0]) * (at as f64 * step).sin() * step;
    let lumen = std::f64::consts::TAU * texels(texture, 0).iter().enumerate().map(part).sum::<f64>();
    assert!((lumen / 800.0 - 1.0).abs() < 1e-4, "{lumen}");
}

#[test]
fn what_is_wrong_with_a_profile_is_told() {
    for (keys, text, expected) in [
        ("ies = \"b.ies\"", DOWNLIGHT.to_owned(), "b.ies"),
        ("ies = \"a.ies\"", DOWNLIGHT.replace("1250", "many"), "`a.ies`: line 12: `many` is not a number"),
        ("ies = \"a.ies\"", DOWNLIGHT.replace("TILT=NONE", "TILT=lamp.tlt"), "only `TILT=NONE` is read"),
        ("ies = \"a.ies\"", WINGS.replacen("300 360 480", "300 360 481", 1), "only round lamps are read"),
        ("ies = \"a.ies\"", String::new(), "it is no IES file"),
        ("ies = \"a.ies\", lumen = -1", DOWNLIGHT.to_owned(), "`lumen` is from 0 on"),
        ("ies = \"a.ies\", values = [1]", DOWNLIGHT.to_owned(), "has no `ies`"),
        ("pattern = \"sky\", lumen = 1", DOWNLIGHT.to_owned(), "`lumen`"),
    ] {
        let told = first_error(&lit(keys), &[("a.ies", &text)]);
        assert!(told.contains(expected), "{keys}: {told}");
    }
}

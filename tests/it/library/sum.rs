//! Compares the sum over the lights (101), as the standard program computes it, with its closed form, and the
//! textbook's programs with the standard one.

use crate::support::compiler;
use glam::DVec3;
use glisten::scene::{MemoryFiles, load};
use glisten_reference::{RenderOptions, render};

const SIDE: usize = 16;

/// All numbers are exact in f32. The beam's axis and the direction of the directional light are not unit vectors.
const SCENE: &str = r#"
global_ambient = [0.125, 0.25, 0.0625]
[framebuffer]
width = 16
height = 16
[[light]]
kind = "directional"
towards = [-1, 2, 2]
ambient = [0.0625, 0.125, 0.25]
diffuse = [1, 0.5, 0.25]
specular = [0.5, 0.25, 1]
[[light]]
kind = "point"
position = [4, 12, 3]
attenuation = [0.5, 0.25, 0.0625]
ambient = [0.25, 0, 0.125]
diffuse = [2, 4, 1]
specular = [8, 2, 4]
[[light]]
kind = "spot"
position = [12, 4, 6]
direction = [-2, 1, -4]
exponent = 6
attenuation = [0.25, 0.125, 0.03125]
ambient = [0.5, 0.25, 0.25]
diffuse = [8, 4, 2]
specular = [4, 8, 16]
[material]
ambient = [0.5, 0.25, 0.75]
diffuse = [0.75, 0.5, 0.25]
specular = [0.25, 0.5, 0.5]
emission = [0.03125, 0.0625, 0]
shininess = 9
specular_model = "blinn_phong"
[[draw]]
vertex = "sum.vert"
fragment = "sum.frag"
vertex_count = 3
"#;

const VERTEX: &str = "#version 150\n\
    void main() { gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 2.0 * float(gl_VertexID & 2) - 1.0, 0.0, 1.0); }";

const FRAGMENT: &str = "#version 150\n#extension GL_ARB_shading_language_include : require\n\
    #include <glisten/standard.glsl>\nout vec4 color;\n\
    void main() {\n\
        vec3 P = vec3(gl_FragCoord.xy, 0.0);\n\
        vec3 V = safeNormalize(vec3(8.0, 8.0, 10.0) - P);\n\
        color = vec4(standardColor(standardReflection(P, vec3(0.0, 0.0, 1.0), V), vec3(1.0)), 1.0);\n\
    }";

/// The literal equation over the numbers of [`SCENE`].
fn equation(p: DVec3) -> DVec3 {
    let v = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let (k_amb, k_diff, k_spec, shininess) = (v(0.5, 0.25, 0.75), v(0.75, 0.5, 0.25), v(0.25, 0.5, 0.5), 9.0);
    let (normal, eye) = (DVec3::Z, (v(8.0, 8.0, 10.0) - p).normalize());
    let term = |l: DVec3, d: f64, c_spot: f64, [amb, diff, spec]: [DVec3; 3]| {
        let half = (l + eye).normalize();
        let i_diff = normal.dot(l).max(0.0) * k_diff * diff;
        let i_spec = normal.dot(half).max(0.0).powf(shininess) * k_spec * spec;
        c_spot * (k_amb * amb + d * (i_diff + i_spec))
    };
    let falloff = |light: DVec3, s: [f64; 3]| {
        let r = (light - p).length();
        1.0 / (s[0] + s[1] * r + s[2] * r * r)
    };
    let parallel =
        term(v(-1.0, 2.0, 2.0) / 3.0, 1.0, 1.0, [v(0.0625, 0.125, 0.25), v(1.0, 0.5, 0.25), v(0.5, 0.25, 1.0)]);
    let point = v(4.0, 12.0, 3.0);
    let from_point = term(
        (point - p).normalize(),
        falloff(point, [0.5, 0.25, 0.0625]),
        1.0,
        [v(0.25, 0.0, 0.125), v(2.0, 4.0, 1.0), v(8.0, 2.0, 4.0)],
    );
    let spot = v(12.0, 4.0, 6.0);
    let l = (spot - p).normalize();
    let beam = (-l.dot(v(-2.0, 1.0, -4.0).normalize())).max(0.0).powf(6.0);
    let from_spot =
        term(l, falloff(spot, [0.25, 0.125, 0.03125]), beam, [v(0.5, 0.25, 0.25), v(8.0, 4.0, 2.0), v(4.0, 8.0, 16.0)]);
    k_amb * v(0.125, 0.25, 0.0625) + v(0.03125, 0.0625, 0.0) + parallel + from_point + from_spot
}

#[test]
fn the_sum_over_the_lights_is_the_equations() {
    let files = MemoryFiles::new([("a.toml", SCENE), ("sum.vert", VERTEX), ("sum.frag", FRAGMENT)]);
    let loaded = load("a.toml", &files, &compiler().with_includes(glisten::library::Embedded));
    let messages: Vec<&str> = loaded.diagnostics.iter().map(|found| found.message.as_str()).collect();
    let scene = loaded.scene.unwrap_or_else(|| panic!("{messages:?}"));
    let picture = render(&scene, &RenderOptions::default()).expect("it draws");
    for (place, pixel) in picture.attachments[0].iter().enumerate() {
        let (x, row) = (place % SIDE, place / SIDE);
        let expected = equation(DVec3::new(x as f64 + 0.5, (SIDE - row) as f64 - 0.5, 0.0));
        let error = (DVec3::new(pixel[0], pixel[1], pixel[2]) - expected).abs();
        // There are some ten roundings of f64 in each step, and the powers amplify them by up to 9.
        assert!(error.max_element() < 200.0 * f64::EPSILON * expected.max_element(), "{x} {row}: {pixel:?} {expected}");
    }
}

/// A sphere under a light of each kind, drawn by a program.
fn ball(program: &str, models: &str) -> Vec<[f64; 4]> {
    let lights = &SCENE[..SCENE.find("[[draw]]").expect("it draws")];
    let lights = lights.replace("specular_model = \"blinn_phong\"\n", models);
    let text = format!(
        "{lights}threshold = 0.75\n[camera]\neye = [1, 2, 6]\n[[draw]]\nprogram = \"{program}\"\n\
         mesh = {{ shape = \"sphere\", radius = 2.0, segments = 16, rings = 8 }}\n[[light]]\nkind = \"hemisphere\"\n\
         axis = [0.0, 2.0, 1.0]\nsky = [0.5, 0.25, 1.0]\nground = [0.125, 0.5, 0.0]\n"
    );
    let files = MemoryFiles::new([("a.toml", text.as_str())]);
    let loaded = load("a.toml", &files, &compiler().with_includes(glisten::library::Embedded));
    let messages: Vec<&str> = loaded.diagnostics.iter().map(|found| found.message.as_str()).collect();
    let scene = loaded.scene.unwrap_or_else(|| panic!("{messages:?}"));
    let picture = render(&scene, &RenderOptions::default()).expect("it draws");
    picture.attachments.first().expect("it has one").clone()
}

/// Attenuation, beam, half spheres, emission and global ambient light are not the standard program's alone.
#[test]
fn the_programs_of_the_textbook_draw_the_whole_equation() {
    for (program, model) in [
        ("lambert", "none"),
        ("phong", "phong"),
        ("blinn_phong", "blinn_phong"),
        ("schlick", "schlick_blinn"),
        ("threshold", "threshold"),
    ] {
        for suffix in ["", "_vertex"] {
            let own = ball(&format!("{program}{suffix}"), "");
            let standard = ball(&format!("standard{suffix}"), &format!("specular_model = \"{model}\"\n"));
            let lit = standard.iter().filter(|pixel| pixel[0] > 0.0).count();
            assert!(lit > 60, "{program}{suffix}: {lit} pixels");
            for (own, standard) in own.iter().zip(&standard) {
                let error = own.iter().zip(standard).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(error < 1e-12, "{program}{suffix}: {own:?} and {standard:?}");
            }
        }
    }
}

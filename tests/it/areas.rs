//! Lights with a shape, light from all around by coefficients, pictures of lit balls, and bodies that light travels in, in the program
//! `standard`.

use crate::drawing::reference;
use crate::layers::{DOME, HEAD_ON, good, middle, near, picture, scene};
use crate::scenes::{the_error, told};
use crate::support::{compiler, root};
use glam::DVec3;
use glisten::evaluate::Evaluator;
use glisten::library::Embedded;
use glisten::scene::{DiskFiles, Loaded, MemoryFiles, load};
use glisten_reference::Precision;
use glisten_scene::picture::Image;
use std::f64::consts::PI;

const PLASTER: &str = "diffuse = [1, 1, 1]\nspecular_model = \"none\"\n";
const PLASTIC: &str = "base_color = [0.5, 0.5, 0.5]\nmetallic = 0.0\n";

/// The point that [`middle`] shows.
const MIDDLE: DVec3 = DVec3::new(0.125, 0.125, 0.0);

/// One light of white radiance.
fn lamp(keys: &str) -> String {
    format!("[[light]]\n{keys}\n")
}

/// The shapes as the library's scenes have them, with points of their surface: places and areas, each facing the origin.
struct Sampled {
    keys: &'static str,
    points: Vec<(DVec3, DVec3, f64)>,
}

/// A rectangle that shines towards the origin.
fn rectangle(keys: &'static str, center: DVec3, [x, y]: [DVec3; 2]) -> Sampled {
    const N: i32 = 96;
    let along = (-center).normalize();
    let at = |k: i32| (f64::from(k) + 0.5) / f64::from(N) * 2.0 - 1.0;
    let area = 4.0 * x.length() * y.length() / f64::from(N * N);
    let points = (0..N * N).map(|k| (center + at(k % N) * x + at(k / N) * y, along, area));
    Sampled { keys, points: points.collect() }
}

/// A sphere, by rings; each point faces away from its middle.
fn sphere(keys: &'static str, center: DVec3, radius: f64) -> Sampled {
    const N: i32 = 160;
    let area = 4.0 * PI * radius * radius / f64::from(N * N);
    let points = (0..N * N).map(|k| {
        let z = (f64::from(k / N) + 0.5) / f64::from(N) * 2.0 - 1.0;
        let (s, c) = (2.0 * PI * (f64::from(k % N) + 0.5) / f64::from(N)).sin_cos();
        let flat = (1.0 - z * z).sqrt();
        let out = DVec3::new(flat * c, flat * s, z);
        (center + radius * out, out, area)
    });
    Sampled { keys, points: points.collect() }
}

/// A tube without its ends.
fn tube(keys: &'static str, [from, to]: [DVec3; 2], radius: f64) -> Sampled {
    const N: i32 = 160;
    let along = (to - from).normalize();
    let (a, b) = along.any_orthonormal_pair();
    let area = 2.0 * PI * radius * from.distance(to) / f64::from(N * N);
    let points = (0..N * N).map(|k| {
        let (s, c) = (2.0 * PI * (f64::from(k % N) + 0.5) / f64::from(N)).sin_cos();
        let out = c * a + s * b;
        (from.lerp(to, (f64::from(k / N) + 0.5) / f64::from(N)) + radius * out, out, area)
    });
    Sampled { keys, points: points.collect() }
}

/// A disk that shines towards the origin.
fn disk(keys: &'static str, center: DVec3, radius: f64) -> Sampled {
    const N: i32 = 128;
    let along = (-center).normalize();
    let (a, b) = along.any_orthonormal_pair();
    let area = PI * radius * radius / f64::from(N * N);
    let points = (0..N * N).map(|k| {
        let r = radius * ((f64::from(k / N) + 0.5) / f64::from(N)).sqrt();
        let (s, c) = (2.0 * PI * (f64::from(k % N) + 0.5) / f64::from(N)).sin_cos();
        (center + r * (c * a + s * b), along, area)
    });
    Sampled { keys, points: points.collect() }
}

/// One of each shape, around the pixel in the middle; all are above the horizon but the last two.
fn lamps() -> Vec<Sampled> {
    let v = DVec3::new;
    vec![
        rectangle(
            "kind = \"rectangle\"\nposition = [0, 2, 2]\ntarget = [0, 0, 0]\nwidth = 1.5\nheight = 1",
            v(0.0, 2.0, 2.0),
            [v(0.75, 0.0, 0.0), v(0.0, 0.5, -0.5).normalize() * 0.5],
        ),
        sphere("kind = \"sphere\"\nposition = [1, 0.5, 1.5]\nradius = 0.5", v(1.0, 0.5, 1.5), 0.5),
        tube(
            "kind = \"tube\"\nfrom = [-1, 0.5, 1]\nto = [1, 0.5, 1.5]\nradius = 0.05",
            [v(-1.0, 0.5, 1.0), v(1.0, 0.5, 1.5)],
            0.05,
        ),
        disk(
            "kind = \"disk\"\nposition = [-1, -1, 1.5]\ndirection = [1, 1, -1.5]\nradius = 0.75",
            v(-1.0, -1.0, 1.5),
            0.75,
        ),
        sphere("kind = \"sphere\"\nposition = [1.5, 0, 0.25]\nradius = 0.5", v(1.5, 0.0, 0.25), 0.5),
        rectangle(
            "kind = \"rectangle\"\nposition = [2, 0, 0.25]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nwidth = 1\nheight = 2",
            v(2.0, 0.0, 0.25),
            [v(-0.25, 0.0, 2.0).normalize() * 0.5, v(0.0, 1.0, 0.0)],
        ),
    ]
}

/// The sum over a light of a factor times pi, for N = V = z: the picture without a shape's closed form.
fn summed(sampled: &Sampled, factor: &Evaluator, more: &[f32]) -> Vec<f64> {
    let (mut rows, mut weights) = (Vec::new(), Vec::new());
    for (point, out, area) in &sampled.points {
        let from = *point - MIDDLE;
        let (d, l) = (from.length(), from.normalize());
        let facing = -out.dot(l);
        if facing > 0.0 && l.z > 0.0 {
            rows.extend([0.0, 0.0, 1.0].into_iter().chain(l.as_vec3().to_array()).chain([0.0, 0.0, 1.0]));
            rows.extend(more);
            weights.push(facing * area / (d * d) / PI);
        }
    }
    let found = factor.reference(&rows, &[], Precision::F64).expect("it is called");
    let n = found.first().map_or(0, Vec::len);
    (0..n).map(|at| found.iter().zip(&weights).map(|(result, weight)| result[at] * weight).sum()).collect()
}

fn factor(text: &str) -> Evaluator {
    let text = format!(
        "#include <glisten/burley.glsl>\n#include <glisten/clearcoat.glsl>\n#include <glisten/ggx.glsl>\n#include <glisten/oren_nayar.glsl>\n{text}"
    );
    Evaluator::new(&compiler().with_includes(Embedded), &text, "f(vec3,vec3,vec3,float)", &[]).expect("it is called")
}

/// The models of the program, as sums over directions: materials, and how far the picture may be from the sum, as a part of it and of 1.
static MODELS: &[(&str, &str, [f64; 2])] = &[
    ("diffuse = [1, 1, 1]\nspecular_model = \"none\"\n", "return vec3(max(dot(N, L), 0.0));", [0.003, 0.002]),
    (
        "diffuse = [1, 1, 1]\nspecular_model = \"none\"\ndiffuse_model = \"eon\"\n",
        "return eonFactor(N, L, V, vec3(1.0), r);",
        [0.04, 0.002],
    ),
    (
        "diffuse = [1, 1, 1]\nspecular_model = \"none\"\ndiffuse_model = \"burley\"\n",
        "return vec3(burleyFactor(N, L, V, r));",
        [0.03, 0.002],
    ),
    (
        "base_color = [1, 0.5, 0.25]\nmetallic = 1.0\n",
        "return ggxFactor(N, L, V, r * r) * fresnelSchlick(dot(V, halfVector(L, V)), vec3(1.0, 0.5, 0.25), vec3(1.0));",
        [0.12, 0.01],
    ),
    (
        "base_color = [0.5, 0.5, 0.5]\nmetallic = 0.0\n",
        "vec3 F = fresnelSchlick(dot(V, halfVector(L, V)), vec3(0.04), vec3(1.0)); return ggxFactor(N, L, V, r * r) * F + 0.5 * max(dot(N, L), 0.0) * (1.0 - F);",
        [0.03, 0.002],
    ),
];

/// The closed forms against sums over thousands of points of each light. With `AREA_TABLE=1` the largest differences are printed.
#[test]
fn lights_with_a_shape_are_the_sum_of_their_points() {
    let mut table = String::new();
    let mut wrong = Vec::new();
    for (material, formula, [relative, absolute]) in MODELS {
        let model = factor(&format!("vec3 f(vec3 N, vec3 L, vec3 V, float r) {{ {formula} }}"));
        let mut most = 0.0_f64;
        for roughness in [0.3, 0.6, 1.0] {
            for sampled in lamps() {
                let wanted = summed(&sampled, &model, &[roughness as f32]);
                let found = middle(&lamp(sampled.keys), &format!("{material}roughness = {roughness:?}\n"));
                for (found, wanted) in found.iter().zip(&wanted) {
                    let off = (found - wanted).abs();
                    most = most.max(off / (wanted + 0.02));
                    if off > relative * wanted + absolute {
                        wrong.push(format!("{material}{roughness} {}: {found} {wanted}", sampled.keys));
                    }
                }
            }
        }
        table += &format!("{formula}: {most:.4}\n");
    }
    if std::env::var_os("AREA_TABLE").is_some() {
        std::io::Write::write_all(&mut std::io::stderr(), table.as_bytes()).expect("standard error can be written to");
    }
    assert!(wrong.is_empty(), "{}\n{table}", wrong.join("\n"));
}

/// A light far away is a point light that shows the same area, whatever the material is.
#[test]
fn small_lights_are_points() {
    let layers = [
        "",
        "clearcoat = 1.0\nclearcoat_roughness = 0.5\n",
        "sheen = [0.5, 0.75, 1]\nsheen_roughness = 0.5\n",
        "subsurface = 1.0\nsubsurface_radius = [0.5, 0.25, 0.1]\n",
        "diffuse_model = \"half_lambert\"\n",
        "diffuse_model = \"oren_nayar\"\n",
        "specular_model = \"beckmann\"\n",
        "specular_model = \"phong\"\n",
    ];
    let disk = "kind = \"disk\"\nposition = [0, 6, 8]\ntarget = [0, 0, 0]\nradius = 0.125\ncolor = [64, 64, 64]";
    let point = "kind = \"directional\"\ntowards = [0, 6, 8]\ncolor = [0.01, 0.01, 0.01]";
    for layer in layers {
        let material = format!("{PLASTIC}roughness = 0.5\n{layer}");
        let [found, wanted] = [disk, point].map(|keys| middle(&lamp(keys), &material));
        let off = found.iter().zip(wanted).map(|(a, b)| (a - b).abs() / b).fold(0.0, f64::max);
        assert!(off < 0.05, "{layer}: {found:?} {wanted:?}");
    }
    // From behind: a window of glass, and a leaf.
    let behind = [disk, point].map(|keys| keys.replace("6, 8]", "2, -9.797959]"));
    for (layer, most) in [("transmission = 1.0\nroughness = 0.6\n", 0.06), ("diffuse_transmission = 0.75\n", 0.03)] {
        let [found, wanted] = [&behind[0], &behind[1]].map(|keys| middle(&lamp(keys), &format!("{PLASTIC}{layer}"))[0]);
        assert!(wanted > 1e-5 && (found / wanted - 1.0).abs() < most, "{layer}: {found} {wanted}");
    }
}

/// A light all over the sky: white layers return all of it.
#[test]
fn a_light_all_over_the_sky_is_white() {
    let sky = lamp("kind = \"rectangle\"\nposition = [0, 0, 1]\ndirection = [0, 0, -1]\nwidth = 1e5\nheight = 1e5");
    let white = "base_color = [1, 1, 1]\nmetallic = 0.0\nroughness = 0.5\n";
    let layers = [
        "",
        "clearcoat = 1.0\n",
        "sheen = [1, 1, 1]\nsheen_roughness = 0.5\n",
        "iridescence = 0.0\n",
        "anisotropy = 0.5\n",
    ];
    for layer in layers {
        near(middle(&sky, &format!("{white}{layer}")), [1.0; 3], 3e-3);
    }
    near(middle(&sky, PLASTER), [1.0; 3], 1e-4);
    // A sphere around the point is light from everywhere.
    near(middle(&lamp("kind = \"sphere\"\nposition = [0, 0, 0.5]\nradius = 2"), PLASTER), [1.0; 3], 1e-6);
}

/// Flat lights shine to one side, or to both.
#[test]
fn flat_lights_have_a_dark_side() {
    for shape in ["kind = \"rectangle\"\nwidth = 1\nheight = 1", "kind = \"disk\"\nradius = 0.5"] {
        let of = |more: &str| middle(&lamp(&format!("{shape}\nposition = [0, 0, 2]\n{more}")), PLASTER)[0];
        let lit = of("direction = [0, 0, -1]");
        assert!(lit > 0.05, "{lit}");
        assert_eq!(of("direction = [0, 0, 3]"), 0.0);
        for both in ["direction = [0, 0, 3]\ntwo_sided = true", "target = [0, 0, 0]"] {
            assert!((of(both) - lit).abs() < 1e-6, "{both}");
        }
    }
    // Colors of the two terms.
    let red = lamp("kind = \"sphere\"\nposition = [0, 0, 2]\nradius = 1\ndiffuse = [1, 0, 0]\nspecular = [0, 1, 0]");
    let [r, g, b, _] = middle(&red, "base_color = [1, 1, 1]\nmetallic = 0.5\nroughness = 0.5\n");
    assert!(r > 0.01 && g > 0.01 && b == 0.0, "{r} {g} {b}");
    // In eye space as in world space: the camera looks along -z in both.
    let eye = good(scene(&red, "light_space = \"eye\"", PLASTER));
    assert!(picture(&eye)[36][0] < 1e-3, "4096 away from the eye there is hardly any light");
}

/// Programs without shapes have a point light instead, and tell.
#[test]
fn programs_without_shapes_have_points() {
    let text = |program: &str, light: &str| {
        format!(
            "[framebuffer]\nwidth = 8\nheight = 8\n[camera]\neye = [0, 0, 4096]\northo = 1\nnear = 4095\nfar = 4097\n[[light]]\n{light}\n[[draw]]\n\
             program = \"{program}\"\nmesh = {{ shape = \"quad\" }}\n[draw.material]\n{PLASTER}"
        )
    };
    let of = |text: &str| -> Loaded {
        let files = MemoryFiles::new([("a.toml", text)]);
        load("a.toml", &files, &compiler().with_includes(Embedded))
    };
    let found = of(&text(
        "lambert",
        "kind = \"rectangle\"\nposition = [0, 0, 8]\ndirection = [0, 0, -1]\nwidth = 2\nheight = 1",
    ));
    let told = told(&found).join("\n");
    assert!(told.contains("does not read `height` and `width`") || told.contains("does not read"), "{told}");
    let lit = picture(&found.scene.expect("a warning"))[36][0];
    assert!((lit - 1.0 / (1.0 + PI * 64.0 / 2.0)).abs() < 1e-3, "{lit}");
}

/// Every mistake has its message.
#[test]
fn mistakes_of_shapes_are_told() {
    for (keys, message) in [
        ("kind = \"sphere\"\nposition = [0, 0, 1]", "a sphere light has no `radius`"),
        ("kind = \"sphere\"\nposition = [0, 0, 1]\nradius = 0", "the `radius` of a light is above 0"),
        ("kind = \"tube\"\nfrom = [0, 0, 1]\nradius = 1", "a tube light has no `to`"),
        ("kind = \"tube\"\nfrom = [0, 0, 1]\nto = [0, 0, 1]\nradius = 1", "a tube light has two ends, `from` and `to`"),
        ("kind = \"disk\"\nposition = [0, 0, 1]\nradius = 1", "a disk light has no `direction`"),
        ("kind = \"disk\"\nposition = [0, 0, 1]\ndirection = [0, 0, 0]\nradius = 1", "a flat light shines somewhere"),
        (
            "kind = \"rectangle\"\nposition = [0, 0, 1]\ntarget = [0, 0, 1]\nwidth = 1\nheight = 1",
            "a flat light shines somewhere",
        ),
        (
            "kind = \"rectangle\"\nposition = [0, 0, 1]\ntarget = [0, 0, 0]\nwidth = 1",
            "a rectangle light has no `height`",
        ),
        (
            "kind = \"rectangle\"\nposition = [0, 0, 1]\ntarget = [0, 0, 0]\nwidth = -1\nheight = 1",
            "the `width` of a light is above 0",
        ),
        ("kind = \"rect\"\nposition = [0, 0, 1]", "`kind`"),
        ("kind = \"sphere\"\nposition = [0, 0, 1]\nradius = 1\nrange = 4", "`range`"),
    ] {
        let (_, _, all) = the_error(&scene(&lamp(keys), "", PLASTER));
        assert!(all.contains(message), "{keys}: {all}");
    }
    let (_, _, all) = the_error(&scene(&lamp("kind = \"rectangel\"\nposition = [0, 0, 1]"), "", PLASTER));
    assert!(all.contains("did you mean \"rectangle\"") || all.contains("did you mean `rectangle`"), "{all}");
}

/// Half spheres as harmonics are the light of that name; nine colors are what they are.
#[test]
fn an_environment_may_be_a_few_colors() {
    let sky = "sky = [1, 0.5, 0.25]\nground = [0.25, 0.5, 0]\naxis = [0, 3, 4]";
    let [around, light] =
        ["[environment]", "[[light]]\nkind = \"hemisphere\""].map(|head| middle(&format!("{head}\n{sky}\n"), PLASTER));
    near(around, [light[0], light[1], light[2]], 1e-6);
    // A metal mirrors what is before it; a rough one shows the matte light.
    let metal = "base_color = [1, 1, 1]\nmetallic = 1.0\nroughness = 0.0\n";
    let up = "[environment]\nsky = [1, 1, 1]\nground = [0, 0, 0]\naxis = [0, 0, 1]\n";
    let [smooth, matte] = [middle(up, metal)[0], middle(up, PLASTER)[0]];
    assert!((matte - 1.0).abs() < 1e-6 && (smooth - 1.25).abs() < 0.01, "{smooth} {matte}");
    // L_00 alone, nested or flat, is light from everywhere: pi^1/2 for a radiance of 1/2.
    for list in [
        "[[2, 1, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]",
        "[2, 1, 0, 0,0,0, 0,0,0, 0,0,0, 0,0,0, 0,0,0, 0,0,0, 0,0,0, 0,0,0]",
    ] {
        let found = middle(&format!("[environment]\ncoefficients = {list}\n"), PLASTER);
        let one = 1.0 / (4.0 * PI).sqrt();
        near(found, [2.0 * one, one, 0.0], 1e-6);
    }
    // White layers in white light.
    let white = "[environment]\nsky = [1, 1, 1]\nground = [1, 1, 1]\n";
    for layer in
        ["", "clearcoat = 1.0", "sheen = [1, 1, 1]\nsheen_roughness = 0.5", "transmission = 1.0", "anisotropy = 0.5"]
    {
        near(
            middle(white, &format!("base_color = [1, 1, 1]\nmetallic = 0.0\nroughness = 0.5\n{layer}")),
            [1.0; 3],
            2e-3,
        );
    }
    for (keys, message) in [
        ("coefficients = [1, 2, 3]", "27 numbers, not 3"),
        ("coefficients = \"white\"", "a list of numbers"),
        ("sky = [1, 1, 1]\naxis = [0, 0, 0]", "points to the middle of its sky"),
        ("sky = [1, 1, 1]\ngrund = [0, 0, 0]", "did you mean `ground`?"),
        ("sky = [1, 1, 1]\nfile = \"a.exr\"", "an environment of two half spheres"),
        (
            "coefficients = [0,0,0, 0,0,0, 0,0,0, 0,0,0, 0,0,0, 0,0,0, 0,0,0, 0,0,0, 0,0,0]\nsky = [1, 1, 1]",
            "an environment by coefficients",
        ),
    ] {
        let (_, _, all) = the_error(&scene(&format!("[environment]\n{keys}\n"), "", PLASTER));
        assert!(all.contains(message), "{keys}: {all}");
    }
}

/// A picture of a ball is all of the light; the normal as the eye sees it is the place in it.
#[test]
fn a_picture_of_a_ball_is_all_of_the_light() {
    // Red and green below, blue and white above; filtered, the middle is their mean.
    let ball =
        "matcap = { width = 2, height = 2, values = [1,0,0,1, 0,1,0,1, 0,0,1,1, 1,1,1,1], filter = \"nearest\" }\n";
    let up = "normal_map = { width = 1, height = 1, values = [0.75, 0.75, 0.9, 1] }\n";
    let down = "normal_map = { width = 1, height = 1, values = [0.25, 0.25, 0.9, 1] }\n";
    near(middle("", &format!("diffuse = [0.5, 0.5, 1]\n{ball}{up}")), [0.5, 0.5, 1.0], 1e-6);
    near(middle("", &format!("diffuse = [0.5, 0.5, 1]\n{ball}{down}")), [0.5, 0.0, 0.0], 1e-6);
    near(
        middle("", &format!("diffuse = [0.5, 0.5, 1]\nemission = [0, 0, 0.25]\n{ball}{down}")),
        [0.5, 0.0, 0.25],
        1e-6,
    );
    // Lights change nothing, and that is told.
    let lit = scene(HEAD_ON, "", &format!("{ball}{down}"));
    let told = told(&lit).join("\n");
    assert!(told.contains("light"), "{told}");
    near(picture(&lit.scene.expect("a warning"))[36], [0.8, 0.0, 0.0], 1e-6);
}

/// The picture that the library's scene has is that of its ball.
#[test]
fn the_librarys_ball_is_drawn_here() {
    let path = root().join("fixtures/library/clay_ball.toml");
    let loaded = load(&path.display().to_string(), &DiskFiles, &compiler());
    let drawn = reference(&good(loaded), Precision::F64);
    let bytes = std::fs::read(root().join("shader_lib/scenes/clay.png")).expect("the picture is there");
    let image = Image::read(&bytes, 4096, 1 << 24).expect("a picture");
    let pairs = image.pixels.iter().zip(&drawn.attachments[0]);
    for (kept, drawn) in pairs {
        for (kept, drawn) in kept.iter().zip(drawn).take(3) {
            let encoded = if *drawn <= 0.0031308 { 12.92 * drawn } else { 1.055 * drawn.powf(1.0 / 2.4) - 0.055 };
            assert!((f64::from(*kept) - encoded.clamp(0.0, 1.0)).abs() < 1.0 / 255.0, "{kept} {drawn}");
        }
    }
}

/// Light that travels in a body reaches around the terminator, more of the colors that travel further; without a way it is Lambert's.
#[test]
fn a_body_softens_its_terminator() {
    let body = |radius: &str, more: &str| {
        let light = "[[light]]\nkind = \"directional\"\ntowards = [0, 1, 0]";
        middle(
            light,
            &format!("diffuse = [0.8, 0.8, 0.8]\nspecular_model = \"none\"\nsubsurface_radius = {radius}\n{more}"),
        )
    };
    let [r, g, b, _] = body("[0.8, 0.4, 0.05]", "");
    assert!(r > 1.2 * g && g > 2.0 * b && b > 0.0, "{r} {g} {b}");
    near(body("[0, 0, 0]", ""), [0.0; 3], 1e-6);
    let [half, ..] = body("[0.8, 0.4, 0.05]", "subsurface = 0.5");
    assert!((half - r / 2.0).abs() < 1e-6);
    // White in white light.
    near(middle(DOME, "diffuse = [1, 1, 1]\nspecular_model = \"none\"\nsubsurface = 1.0"), [1.0; 3], 1e-6);
}

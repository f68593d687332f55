//! The equations next to the pictures of the gallery: evaluated as they are printed, they give the colors of the picture.
//!
//! *In:* the scenes of the library. *Out:* nothing; a difference fails. *Holds:* every formula of every scene is
//! evaluated. A printed formula comes before the library's meaning of a symbol, which is written in the same language
//! ([`sample::MEANINGS`]).

mod facts;
mod geometry;
mod points;
mod sample;
mod tex;
mod triangles;

use glisten::library::scenes;
use glisten::scene::{MemoryFiles, Scene, load};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// The kind of comparison, and its draws.
#[derive(Clone, Copy, Debug)]
enum Shown {
    /// The color of these draws, at the vertices that face the eye.
    Points(&'static [usize]),
    /// The same, and what is interpolated is compared within triangles.
    Triangles(usize),
    /// The texture coordinates that reach the fragments.
    Coordinates(usize),
    /// Where the vertices of an outline come to stand.
    Outline(usize),
    /// The curves of figure 127.
    Curves,
    /// As `Points`, without the scene's hemisphere: the equations are about the direct lights.
    Direct(&'static [usize]),
    /// A program of its own, whose equations are those of these functions, which `library::values` compares with closed forms.
    ByValue(&'static [&'static str]),
}

/// Every scene of the library, and what of it its equations say.
const SHOWN: &[(&str, Shown)] = &[
    ("reflection", Shown::Points(&[0, 1])),
    ("directional", Shown::Points(&[1, 2, 3])),
    ("point", Shown::Points(&[1, 2, 3])),
    ("lambert", Shown::Points(&[0])),
    ("phong", Shown::Points(&[0])),
    ("blinn_phong", Shown::Points(&[0])),
    ("floor_phong", Shown::Points(&[0])),
    ("floor_blinn_phong", Shown::Points(&[0])),
    ("shininess", Shown::Points(&[0, 1, 2, 3, 4, 5, 6, 7, 8])),
    ("cosine", Shown::Curves),
    ("schlick", Shown::Points(&[0])),
    ("schlick_phong", Shown::Points(&[0])),
    ("threshold", Shown::Points(&[0])),
    ("ambient", Shown::Points(&[0])),
    ("illumination", Shown::Points(&[0])),
    ("emission", Shown::Points(&[0, 1])),
    ("lights", Shown::Points(&[0])),
    ("attenuation_constant", Shown::Points(&[0, 1, 3])),
    ("attenuation_linear", Shown::Points(&[0, 1, 3])),
    ("attenuation_quadratic", Shown::Points(&[0, 1, 3])),
    ("spot", Shown::Points(&[1, 2, 3])),
    ("spot_exponents", Shown::Points(&[0])),
    ("faces", Shown::Triangles(0)),
    ("per_vertex", Shown::Triangles(0)),
    ("per_fragment", Shown::Triangles(0)),
    ("vertex_color", Shown::Triangles(0)),
    ("vertex_color_flat", Shown::Triangles(0)),
    ("smooth", Shown::Coordinates(0)),
    ("noperspective", Shown::Coordinates(0)),
    ("diffuse", Shown::Points(&[2])),
    ("specular", Shown::Points(&[2])),
    ("texspec", Shown::Points(&[2])),
    ("metal", Shown::Points(&[2])),
    ("half_lambert", Shown::Points(&[0])),
    ("hemisphere", Shown::Points(&[2])),
    ("hemisphere_table", Shown::Points(&[2])),
    ("hemi_amb", Shown::Points(&[2])),
    ("hemi_spec", Shown::Points(&[2])),
    ("soft", Shown::Points(&[2])),
    ("toon_hard", Shown::Points(&[1])),
    ("edge", Shown::Outline(2)),
    ("edge_knot", Shown::Points(&[3])),
    ("hemi_knot", Shown::Points(&[2])),
    ("metals", Shown::Direct(&[0, 4, 8])),
    ("chess", Shown::ByValue(&["ggxFactor(vec3,vec3,vec3,float)", "fresnelSchlick(float,vec3,vec3)"])),
    ("studio", Shown::ByValue(&["environmentRadiance(sampler2D,vec3,float)", "environmentDominant(vec3,vec3,float)"])),
    ("moon", Shown::Points(&[1])),
    ("wax", Shown::ByValue(&["wrapFactor(vec3,vec3,float)", "burleyFactor(vec3,vec3,vec3,float)"])),
    ("skin", Shown::ByValue(&["subsurfaceBands(float)", "subsurfaceLit(float,float,float)"])),
    ("drawing", Shown::ByValue(&["gooch(vec3,vec3,vec3,vec3)", "rimFactor(vec3,vec3,float)"])),
    ("lobes", Shown::ByValue(&["beckmannDistribution(vec3,vec3,float)", "punctualFalloff(float,float)"])),
    ("pan", Shown::ByValue(&["wardFactor(vec3,vec3,vec3,vec3,vec2)"])),
    ("velvet", Shown::Points(&[0])),
    ("lacquer", Shown::ByValue(&["clearcoatWeight(vec3,vec3,float)"])),
    ("brushed", Shown::ByValue(&["ggxDistribution(vec3,vec3,vec3,vec2)", "ggxBrushed(float,float)"])),
    ("film", Shown::ByValue(&["iridescenceFresnel(float,float,float,float,vec3)"])),
    ("glass", Shown::ByValue(&["transmissionFactor(vec3,vec3,vec3,float)", "transmissionLeft(vec3)"])),
    ("marbles", Shown::ByValue(&["transmissionSphere(vec3,vec3,float)", "transmissionPath(vec3,vec3,float)"])),
    ("lamps", Shown::ByValue(&["areaSphereFactor(vec3,vec3,float)"])),
    ("panels", Shown::ByValue(&["ltcEdge(vec3,vec3)", "ltcPolygon(vec3[16],int,float)"])),
    ("softbox", Shown::ByValue(&["ltcPolygon(vec3[16],int,float)", "ltcAlbedo(sampler2D,vec3,vec3,float,vec3)"])),
    ("shadows", Shown::ByValue(&["shadowPenumbra(float,float,float)", "shadowVariance(vec2,float,float,float)"])),
    ("corner", Shown::ByValue(&["aoSlice(float,float,float)"])),
    ("lux", Shown::ByValue(&["photometryLux(float,float,float)", "photometryProfile(sampler2D,vec3,vec3)"])),
    ("furnace", Shown::ByValue(&["energyCompensation(sampler2D,vec3,vec3,float,vec3)"])),
    ("lines", Shown::ByValue(&["outlineThinned(float,float,float,float)"])),
    ("probe", Shown::ByValue(&["irradiance(vec3,vec3[9])"])),
    ("dusk", Shown::ByValue(&["irradianceLobe(float)", "irradianceMirrored(vec3,vec3[9],float)"])),
    ("clay", Shown::ByValue(&["matcapCoordinate(vec3,vec3)"])),
    ("noises", Shown::ByValue(&["noiseValue(vec3)", "noiseGradient(vec3)"])),
    ("ember", Shown::ByValue(&["dissolveKept(float,float,float)"])),
    ("dial", Shown::ByValue(&["sdfBlend(float,float,float)"])),
    ("mist", Shown::ByValue(&["fogMean(float)", "fogFactor(float,vec3,float,float,float)"])),
    ("tones", Shown::ByValue(&["tonemapReinhard(vec3,float)"])),
];

/// The equations that a scene prints.
fn printed(text: &str) -> Vec<String> {
    let table: toml::Table = text.parse().expect("the scenes are TOML");
    let equations = table["gallery"]["equation"].as_array().expect("a list");
    equations.iter().map(|line| line.as_str().expect("a text").to_owned()).collect()
}

fn scene(name: &str, text: &str) -> Scene {
    let path = format!("{name}.toml");
    let files = MemoryFiles::new([(path.as_str(), text), ("coordinates.frag", triangles::COORDINATES)]);
    let compiler = crate::support::compiler().with_includes(glisten::library::Embedded);
    let loaded = load(&path, &files, &compiler);
    let told: Vec<&str> = loaded.diagnostics.iter().map(|found| found.message.as_str()).collect();
    loaded.scene.unwrap_or_else(|| panic!("{name}: {told:?}"))
}

/// The names of definitions that have been evaluated.
type Used = RefCell<BTreeSet<String>>;

/// Compares a scene with equations. Says what differs.
fn compare(name: &str, text: &str, shown: Shown, equations: &[String]) -> Result<(), String> {
    if let Shown::ByValue(functions) = shown {
        let has_form = |function: &&&str| glisten_verify::measure::forms().any(|form| form.signature == **function);
        let lost = functions.iter().find(|function| !has_form(function));
        return lost.map_or(Ok(()), |lost| Err(format!("`{lost}` has no closed form")));
    }
    let lines: Vec<&str> = equations.iter().map(String::as_str).collect();
    let definitions = tex::definitions(&lines)?;
    let used = Used::default();
    let samples = match shown {
        Shown::Points(draws) | Shown::Direct(draws) => {
            let direct = without_hemisphere(text);
            let text = if matches!(shown, Shown::Direct(_)) { direct.as_str() } else { text };
            // More vertices where a large plane has few.
            let scene =
                scene(name, &text.replace("shape = \"plane\",", "shape = \"plane\", segments = 90, rings = 90,"));
            let mut samples = 0;
            for &draw in draws {
                samples += points::compare(&scene, draw, &definitions, &used)?;
            }
            samples
        }
        Shown::Triangles(draw) => triangles::compare_colors(&scene(name, text), draw, &definitions, &used)?,
        Shown::Coordinates(draw) => {
            let fragment = "vertex = \"<glisten/programs/decal.vert>\"\nfragment = \"coordinates.frag\"";
            let scene =
                scene(name, &text.replace("program = \"decal\"", fragment).replace("textures =", "# textures ="));
            triangles::compare_coordinates(&scene, draw, &definitions, &used)?
        }
        Shown::Outline(draw) => geometry::compare_outline(&scene(name, text), draw, &definitions, &used)?,
        Shown::Curves => geometry::compare_curves(&scene(name, text), &definitions, &used)?,
        Shown::ByValue(_) => 0,
    };
    if samples < 50 {
        return Err(format!("only {samples} samples"));
    }
    let used = used.into_inner();
    match definitions.iter().find(|definition| !used.contains(&definition.name)) {
        Some(unused) => Err(format!("`{}` has no part in the picture", unused.name)),
        None => Ok(()),
    }
}

/// A scene's text without its hemisphere light.
fn without_hemisphere(text: &str) -> String {
    let mut parts: Vec<&str> = text.split("\n[[light]]\n").collect();
    parts.retain(|part| !part.starts_with("kind = \"hemisphere\""));
    let tail = text.split("\n[[light]]\n").last().filter(|last| last.starts_with("kind = \"hemisphere\""));
    // What follows the last light belongs to it by its place in the text.
    let rest = tail.and_then(|tail| tail.find("\n[[draw]]").map(|at| &tail[at..])).unwrap_or_default();
    parts.join("\n[[light]]\n") + rest
}

fn shown(name: &str) -> Shown {
    SHOWN.iter().find(|(known, _)| *known == name).unwrap_or_else(|| panic!("{name} has no row")).1
}

#[test]
fn every_printed_equation_gives_the_colors_of_its_picture() {
    let mut wrong = Vec::new();
    for one in scenes() {
        let equations = printed(one.text);
        if equations.is_empty() {
            wrong.push(format!("{} has no equation", one.name));
        }
        if let Err(error) = compare(one.name, one.text, shown(one.name), &equations) {
            wrong.push(format!("{}: {error}", one.name));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Equations that were next to these pictures once, and others with one mistake.
#[test]
fn a_wrong_equation_is_found() {
    let linear = r"C = (1 - u - v) C_0 + u C_1 + v C_2";
    for (name, equations) in [
        ("faces", vec![linear]),
        ("per_vertex", vec![linear]),
        ("per_fragment", vec![linear]),
        ("smooth", vec![r"C = (1 - u - v) C_0 + u C_1 + v C_2"]),
        ("vertex_color_flat", vec!["C = C_0"]),
        (
            "hemi_spec",
            vec![
                r"C = \max(\mathbf{N} \cdot \mathbf{L}, 0) \, C_{light} + \max(\mathbf{R} \cdot \mathbf{V}, 0)^4 + C_{dome}",
                r"C_{dome} = \frac{1 + \cos\theta}{2} C_{sky} + \frac{1 - \cos\theta}{2} C_{ground}",
            ],
        ),
        ("hemisphere", vec![r"C = \frac{1 + \cos\theta}{2} C_{sky} + \frac{1 - \cos\theta}{2} C_{ground}"]),
        ("lambert", vec![r"I_{diff} = (\mathbf{N} \cdot \mathbf{L}) K_{diff} \otimes L_{diff}"]),
        ("phong", vec![r"I_{spec} = \max(\mathbf{N} \cdot \mathbf{H}, 0)^{K_{shi}} K_{spec} \otimes L_{spec}"]),
        ("attenuation_linear", vec![r"d = \frac{1}{s_c + s_q r + s_l r^2}"]),
        ("attenuation_linear", vec![r"s_l = 2"]),
        ("edge", vec![r"p_{rim} = p + b \, p_w \frac{n}{|n|}"]),
        ("cosine", vec![r"y_1 = \cos^{n}\theta", r"y_2 = e^{-n \theta^2}"]),
        ("metals", vec![r"I_{spec} = \max(\mathbf{N} \cdot \mathbf{H}, 0)^{2} F_0 \otimes L_{spec}"]),
        ("moon", vec![r"I_{diff} = \max(\mathbf{N} \cdot \mathbf{L}, 0) K_{diff} \otimes L_{diff}"]),
        // Right, and not about this picture.
        ("lambert", vec![r"\mathbf{H} = \frac{\mathbf{L} + \mathbf{V}}{|\mathbf{L} + \mathbf{V}|}"]),
    ] {
        let text = scenes().iter().find(|scene| scene.name == name).expect("it is there").text;
        let equations: Vec<String> = equations.into_iter().map(str::to_owned).collect();
        assert!(compare(name, text, shown(name), &equations).is_err(), "{name}: {equations:?} passes");
    }
}

/// Figure 127 in numbers: the largest distance of each power from the normal distribution, as the caption has it.
#[test]
fn the_distances_of_figure_127_are_measured() {
    let text = scenes().iter().find(|scene| scene.name == "cosine").expect("it is there").text;
    let distance = |n: f64| {
        let apart = |step: i32| {
            let theta = f64::from(step) / 1e5 * std::f64::consts::FRAC_PI_2;
            (theta.cos().powf(n) - (-0.5 * n * theta * theta).exp()).abs()
        };
        (0..=100_000).map(apart).fold(0.0, f64::max)
    };
    let [four, many, most] = [4.0, 32.0, 512.0].map(distance);
    let told = format!("at most {four:.3}, {many:.4} and {most:.5} apart");
    assert!(text.contains(&told), "{told}");
}

//! `[[scene]]`: a glTF file as a scene. The files are made here.

use crate::cli::{Folder, code, err};
use crate::lit_scenes::value;
use crate::scenes::{the_error, told};
use crate::support::compiler;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use glisten::scene::{Loaded, MemoryFiles, load};
use glisten_scene::picture::Image;
use glisten_verify::scene::{Blend, BlendFactor, Cull};
use std::collections::BTreeMap;
use std::f32::consts::PI;
use std::fs;

/// A square from (-1, -1) to (1, 1) that faces +z, in parts: each with a material of these, next to each other along x. The last node
/// is a camera at z = 3; then the given ones.
fn squares(materials: &[&str], nodes: &str, more: &str) -> String {
    let corners: [[f32; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let mut floats: Vec<f32> = corners.iter().flat_map(|[x, y]| [*x, *y, 0.0]).collect();
    floats.extend([0.0, 0.0, 1.0].repeat(4));
    floats.extend(corners.iter().flat_map(|[x, y]| [(x + 1.0) / 2.0, (1.0 - y) / 2.0]));
    let mut bytes: Vec<u8> = floats.iter().flat_map(|value| value.to_le_bytes()).collect();
    bytes.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    let n = materials.len();
    let list = |each: &dyn Fn(usize) -> String| (0..n).map(each).collect::<Vec<_>>().join(", ");
    let attributes = r#""attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3"#;
    let meshes = list(&|k| format!(r#"{{"primitives": [{{{attributes}, "material": {k}}}]}}"#));
    let places = list(&|k| format!(r#"{{"mesh": {k}, "translation": [{}, 0, 0]}}"#, 2 * k));
    let numbers = (0..n + 1 + nodes.matches("\"rotation\"").count()).map(|k| k.to_string()).collect::<Vec<_>>();
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [{}]}}],
"nodes": [{places}, {{"camera": 0, "translation": [0, 0, 3]}}{nodes}],
"cameras": [{{"name": "front", "type": "perspective", "perspective": {{"yfov": 0.5, "znear": 0.1}}}}],
"meshes": [{meshes}], "materials": [{}],
"accessors": [
{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}},
{{"bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 4, "type": "VEC3"}},
{{"bufferView": 0, "byteOffset": 96, "componentType": 5126, "count": 4, "type": "VEC2"}},
{{"bufferView": 0, "byteOffset": 128, "componentType": 5123, "count": 6, "type": "SCALAR"}}],
"bufferViews": [{{"buffer": 0, "byteLength": {}}}],
"buffers": [{{"byteLength": {}, "uri": "data:application/octet-stream;base64,{}"}}]{more}}}"#,
        numbers.join(", "),
        materials.join(", "),
        bytes.len(),
        bytes.len(),
        STANDARD.encode(&bytes)
    )
}

const PAINT: &str = r#"{"name": "paint", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.4, 0.2, 1], "metallicFactor": 0, "roughnessFactor": 0.5}}"#;

/// A light of its number, with a rotation so that it is counted.
fn lit(light: usize, place: &str) -> String {
    format!(
        r#", {{"translation": {place}, "rotation": [0, 0, 0, 1], "extensions": {{"KHR_lights_punctual": {{"light": {light}}}}}}}"#
    )
}

fn lights(list: &str) -> String {
    format!(r#", "extensions": {{"KHR_lights_punctual": {{"lights": [{list}]}}}}"#)
}

fn scene(text: &str, file: &str) -> Loaded {
    let files = [("a.toml".to_owned(), text.as_bytes().to_vec()), ("a.gltf".to_owned(), file.as_bytes().to_vec())];
    load("a.toml", &MemoryFiles(BTreeMap::from(files)), &compiler())
}

const PLAIN: &str = "[[scene]]\ngltf = \"a.gltf\"\n";

#[track_caller]
fn near(found: &[f32], wanted: &[f32]) {
    assert_eq!(found.len(), wanted.len());
    let is_near =
        found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() <= 1e-6 * wanted.abs().max(1.0));
    assert!(is_near, "{found:?} {wanted:?}");
}

#[test]
fn materials_lights_and_the_camera_come_from_the_file() {
    let gold = r#"{"name": "gold", "doubleSided": true, "alphaMode": "BLEND", "emissiveFactor": [0.5, 0, 0],
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0.75, 0.25, 0.5], "roughnessFactor": 0.25},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 3}, "KHR_materials_ior": {"ior": 2},
        "KHR_materials_specular": {"specularColorFactor": [1, 0.5, 0]},
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25}}}"#;
    let lamps = r#"{"type": "directional", "intensity": 2}, {"type": "spot", "color": [1, 0.5, 0.25], "intensity": 8, "range": 9,
        "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}}"#;
    let file = squares(&[gold, PAINT], &(lit(0, "[0, 0, 0]") + &lit(1, "[0, 0, 4]")), &lights(lamps));
    let loaded = scene(PLAIN, &file);
    assert!(loaded.diagnostics.is_empty(), "{:?}", told(&loaded));
    let draws = loaded.scene.expect("it loads").draws;
    // What is seen through comes last.
    let [paint, gold] = draws.as_slice() else { panic!("{} draws", draws.len()) };
    assert_eq!((paint.state.cull, paint.state.blend, paint.state.depth_write), (Cull::Back, None, true));
    assert_eq!((gold.state.cull, gold.state.depth_write), (Cull::None, false));
    assert_eq!(gold.state.blend, Some(Blend::new(BlendFactor::SrcAlpha, BlendFactor::OneMinusSrcAlpha)));
    near(&value(paint, "finish.base_color"), &[0.8, 0.4, 0.2]);
    assert_eq!((value(paint, "finish.metallic"), value(paint, "finish.roughness")), (vec![0.0], vec![0.5]));
    assert_eq!((value(paint, "finish.alpha"), value(gold, "finish.alpha")), (vec![-1.0], vec![0.5]));
    assert_eq!((value(gold, "finish.metallic"), value(gold, "finish.two_sided")), (vec![1.0], vec![1.0]));
    near(&value(gold, "finish.dielectric"), &[1.0 / 9.0, 0.5 / 9.0, 0.0]);
    near(&value(gold, "material.emission"), &[1.5, 0.0, 0.0]);
    assert_eq!((value(gold, "finish.clearcoat"), value(gold, "finish.clearcoat_roughness")), (vec![0.5], vec![0.25]));
    assert_eq!(value(paint, "eye"), [0.0, 0.0, 3.0]);
    assert_eq!((value(paint, "lights"), value(paint, "light[0].kind")), (vec![2.0], vec![0.0]));
    near(&value(paint, "light[0].diffuse"), &[2.0 / PI; 3]);
    near(&value(paint, "light[0].direction"), &[0.0, 0.0, -1.0]);
    near(&value(paint, "light[1].specular"), &[8.0 / PI, 4.0 / PI, 2.0 / PI]);
    assert_eq!((value(paint, "light[1].position"), value(paint, "light[1].range")), (vec![0.0, 0.0, 4.0], vec![9.0]));
    near(&value(paint, "light[1].inner"), &[1.0 - 0.25_f32.cos()]);
    near(&value(paint, "light[1].outer"), &[1.0 - 0.5_f32.cos()]);
}

#[test]
fn what_the_scene_says_takes_precedence() {
    let file = squares(&[PAINT], &lit(0, "[0, 0, 1]"), &lights(r#"{"type": "point", "intensity": 1, "range": 2}"#));
    let draw = |text: &str| {
        let loaded = scene(text, &file);
        assert!(loaded.diagnostics.is_empty(), "{:?}", told(&loaded));
        loaded.scene.expect("it loads").draws.remove(0)
    };
    let plain = draw(PLAIN);
    assert_eq!((value(&plain, "lights"), value(&plain, "light[0].range")), (vec![1.0], vec![2.0]));
    // Its own camera, and its lights before those of the file.
    let own = "[camera]\neye = [0, 0, 7]\n[[light]]\nkind = \"directional\"\ntowards = [0, 0, 1]\n";
    let lit = draw(&format!("{own}{PLAIN}"));
    assert_eq!((value(&lit, "eye"), value(&lit, "lights")), (vec![0.0, 0.0, 7.0], vec![2.0]));
    assert_eq!((value(&lit, "light[0].kind"), value(&lit, "light[1].kind")), (vec![0.0], vec![1.0]));
    let unlit = draw(&format!("{own}{PLAIN}lights = false\n"));
    assert_eq!(value(&unlit, "lights"), [1.0]);
    // Materials: those of one name before those of all; draws last.
    let text = format!(
        "{PLAIN}material = {{ roughness = 0.25, metallic = 1.0 }}\nmaterials = {{ paint = {{ roughness = 0.75 }} }}\n\
         draw = {{ cull = \"none\", material = {{ clearcoat = 1.0 }} }}\n"
    );
    let over = draw(&text);
    assert_eq!((value(&over, "finish.roughness"), value(&over, "finish.metallic")), (vec![0.75], vec![1.0]));
    assert_eq!((over.state.cull, value(&over, "finish.clearcoat")), (Cull::None, vec![1.0]));
    near(&value(&over, "finish.base_color"), &[0.8, 0.4, 0.2]);
    // A transform moves all, and what is lit is as bright as before.
    let large = draw(&format!("{PLAIN}transform = {{ scale = 2, translate = [1, 0, 0] }}\n"));
    assert_eq!((value(&large, "eye"), value(&large, "light[0].position")), (vec![1.0, 0.0, 6.0], vec![1.0, 0.0, 2.0]));
    assert_eq!(value(&large, "light[0].range"), [4.0]);
    near(&value(&large, "light[0].diffuse"), &[4.0 / PI; 3]);
    // Nothing says how it is lit, or seen: as for a model alone.
    let dark = squares(&[PAINT], "", "");
    let loaded = scene(&format!("{PLAIN}camera = false\n"), &dark);
    let portrait = loaded.scene.unwrap_or_else(|| panic!("{:?}", loaded.diagnostics)).draws.remove(0);
    assert_eq!(value(&portrait, "lights"), [4.0]);
    assert!(value(&portrait, "eye")[2] > 2.0);
}

#[test]
fn many_lights_of_a_file_have_room() {
    let many = (0..12).map(|_| lit(0, "[0, 0, 1]")).collect::<String>();
    let loaded = scene(PLAIN, &squares(&[PAINT], &many, &lights(r#"{"type": "point"}"#)));
    assert!(loaded.diagnostics.is_empty(), "{:?}", told(&loaded));
    let draws = loaded.scene.expect("it loads").draws;
    assert_eq!((value(&draws[0], "lights"), value(&draws[0], "light[11].kind")), (vec![12.0], vec![1.0]));
}

#[test]
fn wrong_files_and_keys_are_told_with_their_place() {
    let point = lights(r#"{"type": "point", "intensity": 1}"#);
    let file = squares(&[PAINT], &lit(0, "[0, 0, 1]"), &point);
    // What the scene says.
    let name = "\"a.gltf\"";
    let keys: &[(&str, &str, &str, &str)] = &[
        ("camera = \"fromt\"", "E0905", "\"fromt\"", "did you mean `front`?"),
        ("camera = 3", "E0905", "3", "its cameras are `front`, from 0"),
        ("materials = { pain = { roughness = 1.0 } }", "E0905", "pain", "did you mean `paint`?"),
        ("material = { rougness = 1.0 }", "E0903", "rougness", "did you mean `roughness`?"),
        ("light = false", "E0903", "light", "did you mean `lights`?"),
        ("material = { roughness = \"rough\" }", "E0904", "\"rough\"", "roughness"),
    ];
    for (key, id, place, message) in keys {
        let (code, at, text) = the_error(&scene(&format!("{PLAIN}{key}\n"), &file));
        assert!(code == *id && at == *place && text.contains(message), "{key}: {code} {at} {text}");
    }
    let (code, _, text) = the_error(&scene("[[scene]]\nlights = true\n", &file));
    assert!(code == "E0906" && text.contains("names its glTF file"), "{code} {text}");
    let (code, _, text) = the_error(&scene("[[scene]]\ngltf = \"a.gltf\"\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    assert!(code == "E0911" && text.contains("is no glTF file"), "{code} {text}");
    // What the file says.
    let changes: &[(&str, &str, &str)] = &[
        ("{\"light\": 0}", "{\"light\": 7}", "there is no light 7"),
        ("{\"light\": 0}", "{\"light\": -1}", "its light has no number"),
        ("\"intensity\": 1", "\"intensity\": 1e300", "its `intensity` is not a number"),
        ("\"intensity\": 1", "\"intensity\": -1", "not that of a light"),
        ("\"type\": \"point\"", "\"type\": \"laser\"", "its type is `laser`"),
        ("\"type\": \"point\"", "\"type\": \"spot\", \"spot\": {\"innerConeAngle\": 1}", "a larger outer angle"),
        ("\"lights\": [", "\"lamps\": [", "has no list of `lights`"),
        ("\"material\": 0", "\"material\": 5", "there is no material 5"),
        ("\"count\": 6", "\"count\": 7", "reach past the"),
        ("\"count\": 6", "\"count\": 6000000000", "at most"),
        ("\"buffer\": 0", "\"buffer\": 4", "there is no buffer 4"),
        ("base64,", "base64,!", "base64 is malformed"),
        ("\"nodes\": [0,", "\"nodes\": [9,", "there is no node 9"),
        ("\"version\": \"2.0\"", "\"version\": \"1.0\"", "version 2.0 is read"),
        ("[0, 0, 3]", "[0, 0, 1e39]", "not finite"),
    ];
    for (from, to, message) in changes {
        assert!(file.contains(from), "{from}");
        let (code, at, text) = the_error(&scene(PLAIN, &file.replacen(from, to, 1)));
        assert!(code == "E0911" && at == name && text.contains(message), "{to}: {code} {at} {text}");
    }
    // A loop of nodes ends.
    let cycle = file.replacen("\"mesh\": 0,", "\"mesh\": 0, \"children\": [0, 1],", 1);
    let cycle = scene(PLAIN, &cycle);
    assert!(cycle.scene.is_some() && told(&cycle).concat().contains("its nodes are no trees"), "{:?}", told(&cycle));
    // A file is read once for all of its draws, and a missing one is told once.
    let missing = scene("[[scene]]\ngltf = \"b.gltf\"\n", &file);
    assert!(missing.io_error && told(&missing).len() == 1, "{:?}", told(&missing));
}

#[test]
fn what_is_not_drawn_is_a_note() {
    let glass = r#"{"name": "glass", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1},
        "KHR_materials_dispersion": {"dispersion": 2},
        "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": {"index": 0, "texCoord": 1},
        "clearcoatRoughnessTexture": {"index": 0, "texCoord": 2}}}}"#;
    let image = r#", "images": [{"uri": "a.png"}], "textures": [{"source": 0}]"#;
    let loaded = scene(PLAIN, &squares(&[glass], "", image));
    let told = told(&loaded).join("\n");
    for words in [
        "light passes straight through `glass`: it refracts nothing",
        "what is behind `glass` is not blurred",
        "the roughness of the coat of `glass` has texture coordinates of set 2, a third one, and is left out",
    ] {
        assert!(told.contains("W0912") && told.contains(words), "{told}");
    }
}

/// A camera without a view, textures and images that are not there; an image in a file that begins with a byte order mark is read.
#[test]
fn what_is_not_there_is_a_note() {
    let textured = |texture: u32| {
        format!(r#"{{"name": "t", "pbrMetallicRoughness": {{"baseColorTexture": {{"index": {texture}}}}}}}"#)
    };
    let image = r#", "images": [{"uri": "data:image/png;base64,AAAA"}], "textures": [{"source": 0}, {"source": 7}]"#;
    for (texture, words) in [
        (9, "there is no texture 9, which `t` names: it is left out"),
        (1, "there is no image 7, which the texture of `t` names: it is left out"),
    ] {
        let loaded = scene(PLAIN, &squares(&[&textured(texture)], "", image));
        assert!(told(&loaded).concat().contains(words), "{:?}", told(&loaded));
    }
    let blind = squares(&[PAINT], "", "").replace("\"yfov\": 0.5", "\"yfov\": 0");
    let told_of_it = told(&scene(PLAIN, &blind)).concat();
    assert!(told_of_it.contains("camera 0 is left out: its angle, its height or its planes"), "{told_of_it}");
    let marked = format!("\u{feff}{}", squares(&[&textured(0)], "", image));
    let told_of_it = told(&scene(PLAIN, &marked)).concat();
    assert!(!told_of_it.contains("no glTF"), "{told_of_it}");
}

/// In an environment, a thick body is one draw that bends light. A strength of the mirror is one of its own, and leaves pass light on.
#[test]
fn a_body_in_an_environment_bends_light() {
    let glass = r#"{"name": "glass", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5}, "extensions": {
        "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.75},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [1, 0.25, 1]},
        "KHR_materials_dispersion": {"dispersion": 2}}}"#;
    let pane = r#"{"name": "pane", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}"#;
    let leaf = r#"{"name": "leaf", "pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5, "diffuseTransmissionColorFactor": [0.5, 1, 0.25]},
        "KHR_materials_specular": {"specularFactor": 0.25, "specularColorFactor": [2, 1, 1]}}}"#;
    let file = squares(&[glass, pane, leaf], "", "");
    let around = "[environment]\nwidth = 1\nheight = 2\nvalues = [1, 1, 1, 1,  0.5, 0.5, 0.5, 1]\n";
    let loaded = scene(&format!("{around}{PLAIN}"), &file);
    let messages = told(&loaded).join("\n");
    assert!(messages.contains("`glass` shows the environment through itself"), "{messages}");
    assert!(!messages.contains("straight") && messages.contains("what is behind `pane` is not blurred"), "{messages}");
    let draws = loaded.scene.expect("it loads").draws;
    // The pane is last, in two draws.
    let [glass, leaf, _, surface] = draws.as_slice() else { panic!("{} draws", draws.len()) };
    assert_eq!((value(glass, "finish.transmission_pass"), glass.state.blend), (vec![0.0], None));
    assert!(glass.state.depth_write && surface.state.blend.is_some());
    near(&value(glass, "finish.refraction"), &[1.75]);
    near(&value(glass, "finish.dispersion"), &[2.0]);
    near(&value(glass, "finish.absorption"), &[0.0, 2.0_f32.ln(), 0.0]);
    near(&value(leaf, "finish.leaf"), &[0.5]);
    near(&value(leaf, "finish.leaf_color"), &[0.5, 1.0, 0.25]);
    near(&value(leaf, "finish.dielectric_strength"), &[0.25]);
    near(&value(leaf, "finish.dielectric"), &[0.08, 0.04, 0.04]);
    assert_eq!(value(leaf, "lights"), [0.0]);
    // Where the scene says so, or without one, it is as thin as a wall.
    let thin = scene(&format!("{around}{PLAIN}refraction = false\n"), &file);
    assert_eq!(thin.scene.expect("it loads").draws.len(), 5);
    let plain = scene(PLAIN, &file);
    assert!(told(&plain).join("\n").contains("`glass`: it refracts nothing, as the scene has no `[environment]`"));
    assert_eq!(plain.scene.expect("it loads").draws.len(), 5);
}

/// The layers of extensions are keys of the material.
#[test]
fn extensions_become_layers() {
    let all = r#"{"name": "all", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}, "extensions": {
        "KHR_materials_sheen": {"sheenColorFactor": [0.5, 2, 0.25], "sheenRoughnessFactor": 0.75, "sheenColorTexture": {"index": 0}},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 1.5707963267948966},
        "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1.8, "iridescenceThicknessMaximum": 600,
            "iridescenceThicknessTexture": {"index": 0}},
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatTexture": {"index": 0, "texCoord": 1}, "clearcoatNormalTexture": {"index": 0, "scale": 0.5}},
        "KHR_materials_specular": {"specularTexture": {"index": 0}, "specularColorTexture": {"index": 0}},
        "KHR_materials_transmission": {"transmissionFactor": 0.5, "transmissionTexture": {"index": 0}},
        "KHR_materials_volume": {"thicknessFactor": 2, "attenuationDistance": 4, "attenuationColor": [1, 0.5, 0],
            "thicknessTexture": {"index": 0}}}}"#;
    // Layers without strength are none, and a coat without strength has no textures.
    let none = r#"{"name": "none", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform":
        {"offset": [0.25, 0.5], "scale": [2, 3]}}}}, "extensions": {"KHR_materials_sheen": {"sheenRoughnessFactor": 1},
        "KHR_materials_anisotropy": {}, "KHR_materials_iridescence": {"iridescenceTexture": {"index": 0}},
        "KHR_materials_transmission": {}, "KHR_materials_clearcoat": {"clearcoatTexture": {"index": 0}}}}"#;
    let dot = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAAC0lEQVR4nGP4DwQACfsD/fteaysAAAAASUVORK5CYII=";
    let images = format!(
        r#", "images": [{{"uri": "data:image/png;base64,{dot}"}}], "samplers": [{{"wrapS": 33071}}], "textures": [{{"source": 0, "sampler": 0}}]"#
    );
    let loaded = scene(PLAIN, &squares(&[all, none], "", &images));
    let messages = told(&loaded);
    // Only a volume refracts, and nobody has so many layers with textures.
    let codes: Vec<&str> = messages.iter().filter_map(|message| message.split(':').next()).collect();
    assert_eq!(codes, ["W0912", "W0706"], "{messages:?}");
    let draws = loaded.scene.expect("it loads").draws;
    // Glass is drawn last: what passes, and what it mirrors.
    let [none, through, surface] = draws.as_slice() else { panic!("{} draws", draws.len()) };
    near(&value(none, "places.decal.s"), &[2.0, 0.0, 0.25]);
    // t grows upwards, from the lower edge: 1 - 0.5 - 3 (1 - t).
    near(&value(none, "places.decal.t"), &[0.0, 3.0, -2.5]);
    let names = |draw: &glisten_verify::scene::Draw| {
        draw.program.interface.uniforms.iter().map(|leaf| leaf.name.clone()).collect::<Vec<_>>().join(" ")
    };
    for member in ["sheen", "anisotropy", "film", "transmission"] {
        assert!(!names(none).contains(&format!("finish.{member} ")), "{member}");
    }
    assert_eq!(
        (value(through, "finish.transmission_pass"), value(surface, "finish.transmission_pass")),
        (vec![1.0], vec![2.0])
    );
    assert_eq!(through.state.blend, Some(Blend::new(BlendFactor::DstColor, BlendFactor::Zero)));
    assert_eq!(surface.state.blend, Some(Blend::new(BlendFactor::One, BlendFactor::One)));
    for draw in [through, surface] {
        assert!(!draw.state.depth_write);
        near(&value(draw, "finish.sheen"), &[0.5, 1.0, 0.25]);
        near(&value(draw, "finish.sheen_roughness"), &[0.75]);
        near(&value(draw, "finish.anisotropy"), &[0.5]);
        near(&value(draw, "finish.anisotropy_turn"), &[0.0, 1.0]);
        near(&value(draw, "finish.film_index"), &[1.8]);
        near(&value(draw, "finish.film_thickness"), &[600.0]);
        near(&value(draw, "finish.film_thinnest"), &[100.0]);
        near(&value(draw, "finish.clearcoat_normal_scale"), &[0.5]);
        near(&value(draw, "places.clearcoat_map.second"), &[1.0]);
        near(&value(draw, "places.sheen_map.second"), &[0.0]);
        near(&value(draw, "finish.transmission"), &[0.5]);
        near(&value(draw, "finish.absorption"), &[0.0, 0.5 * 2.0_f32.ln(), 64.0]);
    }
}

#[test]
fn the_picture_is_that_of_the_equation() {
    let flat = r#"{"name": "flat", "pbrMetallicRoughness": {"baseColorFactor": [0.25, 0.5, 0.75, 1]}, "extensions": {"KHR_materials_unlit": {}}}"#;
    let sun = lights(r#"{"type": "directional", "intensity": 2}"#);
    let lit_file = squares(&[PAINT], &lit(0, "[0, 0, 0]"), &sun);
    let flat_file = squares(&[flat], "", "");
    let scene = "[framebuffer]\nwidth = 9\nheight = 9\n[[scene]]\ngltf = \"NAME.gltf\"\n";
    let (lit_scene, flat_scene) = (scene.replace("NAME", "lit"), scene.replace("NAME", "flat"));
    let folder = Folder::new(&[
        ("lit.gltf", lit_file.as_bytes()),
        ("flat.gltf", flat_file.as_bytes()),
        ("lit.toml", lit_scene.as_bytes()),
        ("flat.toml", flat_scene.as_bytes()),
    ]);
    let middle = |name: &str| {
        let output = folder.run(&["render", &format!("{name}.toml"), "--backend", "cpu", "-o", "a.png"]);
        assert_eq!(code(&output), 0, "{}", err(&output));
        let bytes = fs::read(folder.path("a.png")).expect("written");
        Image::read(&bytes, 4096, 1 << 24).expect("a PNG").pixels[40]
    };
    // Light, eye and normal are one: f = (1 - F) c / pi + F D V, with D = 1 / (pi alpha^2), V = 1 / 4.
    let (mirrored, alpha) = (0.04_f32, 0.25_f32);
    let gloss = mirrored / (PI * alpha * alpha) * 0.25;
    for (found, color) in middle("lit").into_iter().zip([0.8, 0.4, 0.2]) {
        let wanted = 2.0 * ((1.0 - mirrored) * color / PI + gloss);
        assert!((found - wanted).abs() < 0.6 / 255.0, "{found} {wanted}");
    }
    for (found, wanted) in middle("flat").into_iter().zip([0.25, 0.5, 0.75]) {
        assert!((found - wanted).abs() < 0.6 / 255.0, "{found} {wanted}");
    }
}

/// EXT_mesh_gpu_instancing: a mesh as often as its attributes say. The corners of the square are three places, and three sizes.
#[test]
fn copies_of_a_mesh_are_drawn() {
    let copied = |attributes: &str| {
        let node = format!(
            "{{\"mesh\": 0, \"extensions\": {{\"EXT_mesh_gpu_instancing\": {{\"attributes\": {attributes}}}}}, \"translation\": [0, 0, 0]}}"
        );
        squares(&[PAINT], "", r#", "extensionsRequired": ["EXT_mesh_gpu_instancing"]"#).replacen(
            "{\"mesh\": 0, \"translation\": [0, 0, 0]}",
            &node,
            1,
        )
    };
    let loaded = scene(PLAIN, &copied(r#"{"TRANSLATION": 0}"#));
    assert!(loaded.diagnostics.is_empty(), "{:?}", told(&loaded));
    let draws = loaded.scene.expect("it loads").draws;
    assert_eq!(draws[0].indices.as_ref().map(Vec::len), Some(4 * 6));
    // What has no triangles or no accessor.
    for (attributes, words) in [
        (r#"{"TRANSLATION": "a"}"#, "the TRANSLATION of its copies is no accessor"),
        (r#"{"SCALE": 99}"#, "there is no accessor 99"),
    ] {
        let (code, _, text) = the_error(&scene(PLAIN, &copied(attributes)));
        assert!(code == "E0911" && text.contains(words), "{text}");
    }
    let none = scene(PLAIN, &copied("{}"));
    assert!(told(&none).join("\n").contains("draws nothing"), "{:?}", told(&none));
}

/// A file of lights, or of a camera: other files and draws have the meshes.
#[test]
fn a_file_may_have_no_meshes() {
    let nothing = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{}]}"#;
    let lamps = nothing.replacen(
        "[{}]}",
        r#"[{"translation": [0, 0, 5], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 4}]}}}"#,
        1,
    );
    let squares = squares(&[PAINT], "", "");
    let both = |text: &str| {
        let files = [("a.toml", text), ("a.gltf", squares.as_str()), ("lamps.gltf", &lamps), ("none.gltf", nothing)];
        load("a.toml", &MemoryFiles::new(files), &compiler())
    };
    let loaded = both("[[scene]]\ngltf = \"lamps.gltf\"\n[[scene]]\ngltf = \"a.gltf\"\n");
    assert!(loaded.diagnostics.is_empty(), "{:?}", told(&loaded));
    let draws = loaded.scene.expect("it loads").draws;
    assert_eq!((draws.len(), value(&draws[0], "lights"), value(&draws[0], "eye")), (1, vec![1.0], vec![0.0, 0.0, 3.0]));
    near(&value(&draws[0], "light[0].position"), &[0.0, 0.0, 5.0]);
    let own = "[camera]\neye = [0, 0, 3]\n[[scene]]\ngltf = \"lamps.gltf\"\n[[draw]]\nprogram = \"standard\"\nmesh = { shape = \"quad\" }\n\
        material = { diffuse = [1, 1, 1] }\n";
    let loaded = both(own);
    assert!(loaded.diagnostics.is_empty(), "{:?}", told(&loaded));
    assert_eq!(value(&loaded.scene.expect("it loads").draws[0], "lights"), [1.0]);
    // Without a camera, the first file with meshes is framed.
    let loaded = both("[[scene]]\ngltf = \"lamps.gltf\"\n[[scene]]\ngltf = \"a.gltf\"\ncamera = false\n");
    assert!(value(&loaded.scene.expect("it loads").draws[0], "eye")[2] > 2.0);
    let (code, _, text) = the_error(&both("[[scene]]\ngltf = \"none.gltf\"\n"));
    assert!(code == "E0911" && text.contains("it has no meshes, no lights and no cameras"), "{text}");
    let as_mesh =
        "[[draw]]\nprogram = \"standard\"\nmesh = { file = \"lamps.gltf\" }\nmaterial = { diffuse = [1, 1, 1] }\n";
    let (code, _, text) = the_error(&both(as_mesh));
    assert!(code == "E0911" && text.contains("`lamps.gltf`: it has no meshes"), "{text}");
}

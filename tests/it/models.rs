//! Models from the disk: OBJ and glTF in scenes, and the scene that a model gets.

use crate::cli::{Folder, code, err};
use crate::scenes::{the_error, told};
use crate::support::{compiler, root};
use glisten::scene::{FileError, FileSource, Loaded, MemoryFiles, load};
use glisten_scene::picture::Image;
use glisten_verify::scene::Draw;
use std::collections::BTreeMap;
use std::fs;

fn fixture(name: &str) -> Vec<u8> {
    fs::read(root().join("fixtures/models").join(name)).expect("the fixture is there")
}

/// A scene with a mesh from a file.
fn with_mesh(file: &str, bytes: &[u8], keys: &str) -> Loaded {
    let text = format!(
        "[[draw]]\nprogram = \"standard\"\nmesh = {{ file = \"{file}\"{keys} }}\n\
         material = {{ diffuse = [0.8, 0.8, 0.8] }}\n"
    );
    let files = BTreeMap::from([("a.toml".to_owned(), text.into_bytes()), (file.to_owned(), bytes.to_vec())]);
    load("a.toml", &MemoryFiles(files), &compiler())
}

fn drawn(file: &str, bytes: &[u8], keys: &str) -> Draw {
    let loaded = with_mesh(file, bytes, keys);
    assert!(loaded.diagnostics.is_empty(), "{:?}", told(&loaded));
    loaded.scene.expect("it loads").draws.remove(0)
}

/// The rows of an attribute.
pub(crate) fn rows(draw: &Draw, name: &str) -> Vec<Vec<f32>> {
    let index =
        draw.program.interface.attributes.iter().position(|attribute| attribute.name == name).expect("declared");
    let data = draw.attributes[index].as_ref().expect("it has data");
    let glisten_verify::scene::AttributeValues::Float(values) = &data.values else { panic!("floats") };
    values.chunks(data.size as usize).map(<[f32]>::to_vec).collect()
}

/// A prism of `sides` sides, of quads, with two polygons as its ends.
fn prism(sides: usize) -> String {
    let mut text = String::new();
    for k in 0..sides {
        let (x, z) = (k as f64 / sides as f64 * std::f64::consts::TAU).sin_cos();
        text.push_str(&format!("v {x} 0 {z}\nv {x} 1 {z}\n"));
    }
    for k in 0..sides {
        let (a, b) = (2 * k + 1, 2 * ((k + 1) % sides) + 1);
        text.push_str(&format!("f {a} {b} {} {}\n", b + 1, a + 1));
    }
    let list = |odd: usize, order: &mut dyn Iterator<Item = usize>| {
        order.map(|k| (2 * k + 1 + odd).to_string()).collect::<Vec<_>>().join(" ")
    };
    format!("{text}f {}\nf {}\n", list(1, &mut (0..sides)), list(0, &mut (0..sides).rev()))
}

#[test]
fn an_obj_without_normals_and_texture_coordinates_gets_them() {
    let text = prism(12);
    let draw = drawn("a.obj", text.as_bytes(), "");
    let (positions, normals) = (rows(&draw, "position"), rows(&draw, "normal"));
    // The sides are one surface; the edges to the ends are sharp: two vertices at each point.
    assert_eq!(positions.len(), 48);
    for (position, normal) in positions.iter().zip(&normals) {
        let (x, z) = (position[0], position[2]);
        let expected = if normal[1].abs() > 0.5 { [0.0, position[1].mul_add(2.0, -1.0), 0.0] } else { [x, 0.0, z] };
        let error = normal.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(error < 1e-6, "{position:?} {normal:?}");
    }
    assert!(rows(&draw, "texcoord").iter().all(|row| row == &[0.0, 0.0]));
    let flat = rows(&drawn("a.obj", text.as_bytes(), ", normals = \"flat\""), "normal");
    assert_eq!(flat.len(), 12 * 4 + 24);
    let creased = rows(&drawn("a.obj", text.as_bytes(), ", crease = 20"), "normal");
    assert_eq!(creased.len(), flat.len());
    let round = rows(&drawn("a.obj", text.as_bytes(), ", crease = 180"), "normal");
    assert_eq!(round.len(), 24);
}

#[test]
fn a_file_with_normals_keeps_them_unless_asked() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nvt 0.5 0.25\nf 1/1/1 2/1/1 3/1/1\n";
    let draw = drawn("a.obj", text.as_bytes(), "");
    assert_eq!(
        (rows(&draw, "normal"), rows(&draw, "texcoord")),
        (vec![vec![1.0, 0.0, 0.0]; 3], vec![vec![0.5, 0.25]; 3])
    );
    let draw = drawn("a.obj", text.as_bytes(), ", normals = \"smooth\"");
    assert_eq!(rows(&draw, "normal"), vec![vec![0.0, 0.0, 1.0]; 3]);
}

#[test]
fn materials_select_triangles_and_degenerate_ones_are_left_out() {
    let vase = fixture("vase.obj");
    let count = |keys: &str| drawn("vase.obj", &vase, keys).vertex_count;
    let (clay, glaze, all) = (count(", material = \"clay\""), count(", material = \"glaze\""), count(""));
    assert_eq!((clay + glaze, glaze), (all, 2 * 20 * 2 * 3));
    assert_eq!(count(", material = 1"), glaze);
    let (code, place, text) = the_error(&with_mesh("vase.obj", &vase, ", material = \"glaze!\""));
    assert!((code, place.as_str()) == ("E0905", "\"glaze!\"") && text.contains("did you mean `glaze`?"), "{text}");
    let (code, _, text) = the_error(&with_mesh("a.obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 2\n", ""));
    assert!(code == "E0911" && text.contains("all of its triangles are without area"), "{text}");
}

#[test]
fn wrong_models_are_told_with_their_line() {
    let cases: &[(&str, &[u8], &str)] = &[
        ("a.obj", b"v 0 0 0\nf 1 2 3\n", "`a.obj`: line 2: `2` names position 2"),
        ("a.obj", b"v 0 0\n", "line 1: a position has three numbers"),
        ("a.obj", b"v 0 0 0\nv 1 1 1\n", "it has 2 positions and no faces"),
        ("a.obj", b"", "it has no faces"),
        ("a.stl", b"solid cube\n", "it is STL; meshes are read from Wavefront's OBJ and from glTF 2.0"),
        ("a.obj", b"ply\nformat ascii 1.0\n", "it is PLY"),
        ("a.obj", b"\x00\x01\x02", "it is binary, and no glTF"),
        ("a.gltf", b"{ \"asset\": {\"version\": \"1.0\"} }", "it is glTF 1.0, and version 2.0 is read"),
        ("a.gltf", b"{ \"asset\": ", "it is no glTF 2.0: EOF while parsing"),
        ("a.glb", b"glTF\x02\x00\x00\x00", "the file ends in its header"),
        ("a.gltf", b"", "it is no glTF 2.0: it is empty"),
        ("a.gltf", b"[]", "it is no glTF 2.0: it begins neither with `{` nor with `glTF`"),
        (
            "a.gltf",
            b"{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]}",
            "its meshes are compressed by Draco (KHR_draco_mesh_compression): export it without compression",
        ),
        ("a.gltf", b"{\"asset\":{\"version\":\"2.0\"}}", "it has no meshes"),
    ];
    for (file, bytes, message) in cases {
        let (code, _, text) = the_error(&with_mesh(file, bytes, ""));
        assert!(code == "E0911" && text.contains(message), "{text}");
    }
    for keys in [", normals = \"file\"", ", normals = \"soft\"", ", crease = 200", ", normals = \"flat\", crease = 3"] {
        let loaded = with_mesh("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", keys);
        the_error(&loaded);
    }
    let (code, _, text) =
        the_error(&with_mesh("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ", color = \"normal\""));
    assert!(code == "E0911" && text.contains("`a.obj` has no colors"), "{text}");
}

/// All that a file names is in it, and indices are integers.
#[test]
fn wrong_references_of_gltf_are_told() {
    let sparse = r#""sparse": {"count": 25, "indices": {"bufferView": 3, "componentType": 5123}, "values": {"bufferView": 0}}, "#;
    for (from, to, message) in [
        ("\"mesh\": 0,", "\"mesh\": 0, \"skin\": 3,".to_owned(), "there is no skin 3"),
        ("\"count\": 24", format!("{sparse}\"count\": 24"), "25 of its 24 elements are sparse"),
        ("\"indices\": 3", "\"indices\": 0".to_owned(), "accessor 0: indices are single unsigned integers"),
    ] {
        let wrong = boxes(|text| {
            assert!(text.contains(from), "{from}: {text}");
            text.replacen(from, &to, 1)
        });
        let (code, _, text) = the_error(&with_mesh("a.gltf", &wrong, ""));
        assert!(code == "E0911" && text.contains(message), "{text}");
    }
    // A file that it names and that cannot be read is no fault of its content.
    let elsewhere = boxes(|text| {
        let (before, data) = text.split_once("data:application").expect("it has a buffer");
        let (_, after) = data.split_once('"').expect("the data end");
        format!("{before}no.bin\"{after}")
    });
    let (code, _, said) = the_error(&with_mesh("a.gltf", &elsewhere, ""));
    assert!(code == "E0901" && said.contains("cannot read `no.bin`: there is no such file"), "{said}");
}

/// The box of `boxes.gltf`, changed.
fn boxes(change: impl Fn(String) -> String) -> Vec<u8> {
    change(String::from_utf8(fixture("boxes.gltf")).expect("JSON")).into_bytes()
}

#[test]
fn gltf_nodes_place_their_meshes_and_binary_says_the_same() {
    let (text, binary) = (fixture("boxes.gltf"), fixture("boxes.glb"));
    let draw = drawn("boxes.gltf", &text, "");
    assert_eq!(draw.vertex_count, 72);
    assert_eq!(rows(&draw, "position"), rows(&drawn("boxes.glb", &binary, ""), "position"));
    // The large box is turned by 30 degrees about y, at (-1.4, 1, 0) before that.
    let positions = rows(&drawn("boxes.gltf", &text, ", material = \"checked\""), "position");
    let (sin, cos) = (0.5_f32, 0.75_f32.sqrt());
    let expected = [-1.4 + 1.0, 1.0 + 1.0, 1.0].map(|value: f32| value);
    let turned = [cos * expected[0] + sin * expected[2], expected[1], -sin * expected[0] + cos * expected[2]];
    let nearest = |row: &Vec<f32>| row.iter().zip(turned).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(positions.iter().map(nearest).fold(f32::INFINITY, f32::min) < 1e-5, "{positions:?}");
    // The mirrored one has no normals; those that are computed point away from its middle.
    let small = drawn("boxes.gltf", &text, ", material = \"brass\"");
    let (positions, normals) = (rows(&small, "position"), rows(&small, "normal"));
    let middle: Vec<f32> =
        (0..3).map(|axis| positions.iter().map(|row| row[axis]).sum::<f32>() / positions.len() as f32).collect();
    for (position, normal) in positions.iter().zip(&normals) {
        let outward: f32 = (0..3).map(|axis| (position[axis] - middle[axis]) * normal[axis]).sum();
        assert!(outward > 0.5, "{position:?} {normal:?}");
    }
    // The checker's picture begins at its top: glTF's t grows downwards.
    let texcoords = rows(&drawn("boxes.gltf", &text, ", material = \"checked\""), "texcoord");
    assert!(texcoords.contains(&vec![0.0, 0.0]) && texcoords.contains(&vec![1.0, 1.0]));
}

#[test]
fn damaged_gltf_is_an_error_and_never_a_panic() {
    let binary = fixture("boxes.glb");
    for len in (0..binary.len()).step_by(41) {
        let loaded = with_mesh("a.glb", &binary[..len], "");
        assert!(loaded.scene.is_none() || len + 8 > binary.len(), "{len}");
    }
    let mut seed = 0x2545_f491_u32;
    let mut next = || {
        seed ^= seed << 13;
        seed ^= seed >> 17;
        seed ^= seed << 5;
        seed
    };
    for _ in 0..80 {
        let mut damaged = binary.clone();
        for _ in 0..3 {
            let at = next() as usize % damaged.len();
            damaged[at] = next() as u8;
        }
        with_mesh("a.glb", &damaged, "");
    }
    let changes: &[(&str, &str, &str)] = &[
        ("\"count\": 24", "\"count\": 25", "its 25 elements reach past the 288 bytes of its view"),
        ("\"count\": 36", "\"count\": 99999999999", "at most"),
        ("\"byteOffset\": 576", "\"byteOffset\": 99999999", "and its buffer has"),
        ("\"indices\": 3", "\"indices\": 33", "there is no accessor 33"),
        ("\"mesh\": 1", "\"mesh\": 7", "there is no mesh 7"),
        ("base64,", "base64,?", "its base64 is malformed"),
        ("data:application/octet-stream;base64,", "https://example.org/", "nothing is downloaded"),
    ];
    for (from, to, message) in changes {
        let bytes = boxes(|text| {
            assert!(text.contains(from), "{from}");
            text.replacen(from, to, 1)
        });
        let (code, _, text) = the_error(&with_mesh("a.gltf", &bytes, ""));
        assert!(code == "E0911" && text.contains(message), "{text}");
    }
    // A cycle of nodes ends.
    let cycle = boxes(|text| text.replacen("\"mesh\": 0,", "\"mesh\": 0, \"children\": [0, 1],", 1));
    assert!(with_mesh("a.gltf", &cycle, "").scene.is_some());
}

#[test]
fn textures_may_be_inside_of_a_gltf_file() {
    let text = "[[draw]]\nprogram = \"standard\"\nmesh = { file = \"boxes.glb\" }\nmaterial = { decal = { file = \"boxes.glb\", image = 0 } }\n";
    let read = |text: &str| {
        let files = [("a.toml".to_owned(), text.as_bytes().to_vec()), ("boxes.glb".to_owned(), fixture("boxes.glb"))];
        load("a.toml", &MemoryFiles(BTreeMap::from(files)), &compiler())
    };
    let loaded = read(text);
    let scene = loaded.scene.as_ref().unwrap_or_else(|| panic!("{:?}", told(&loaded)));
    let decal = scene.draws[0].textures.iter().flatten().find(|texture| texture.levels[0].width == 4);
    assert!(decal.is_some());
    let (code, place, message) = the_error(&read(&text.replace("image = 0", "image = 3")));
    assert!(
        (code, place.as_str()) == ("E0911", "3") && message.contains("it has 1 images, and none of number 3"),
        "{message}"
    );
}

/// A mesh of a shader of one's own is fed by the names of its attributes, tangents included.
#[test]
fn tangents_follow_texture_coordinates() {
    let vertex = "#version 150\nin vec3 aPos;\nin vec3 aNormal;\nin vec2 aTexCoords;\nin vec4 a_tangent;\nin vec3 binormal;\nout vec3 v;\n\
        void main() { v = cross(aNormal, a_tangent.xyz) * a_tangent.w - binormal + vec3(aTexCoords, 0.0); gl_Position = vec4(aPos, 1.0); }\n";
    let fragment = "#version 150\nin vec3 v;\nout vec4 c;\nvoid main() { c = vec4(v, 1.0); }\n";
    let scene = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nmesh = { shape = \"sphere\" }\n";
    let files = MemoryFiles::new([("a.toml", scene), ("a.vert", vertex), ("a.frag", fragment)]);
    let loaded = load("a.toml", &files, &compiler());
    assert!(loaded.diagnostics.is_empty(), "{:?}", told(&loaded));
    let draw = &loaded.scene.expect("it loads").draws[0];
    let (normals, tangents, bitangents) = (rows(draw, "aNormal"), rows(draw, "a_tangent"), rows(draw, "binormal"));
    let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).take(3).map(|(a, b)| a * b).sum::<f32>();
    for ((normal, tangent), bitangent) in normals.iter().zip(&tangents).zip(&bitangents) {
        assert!(
            dot(normal, tangent).abs() < 1e-6 && (dot(tangent, tangent) - 1.0).abs() < 1e-6,
            "{normal:?} {tangent:?}"
        );
        assert!(dot(bitangent, normal).abs() < 1e-6 && dot(bitangent, tangent).abs() < 1e-6);
    }
    // At the equator in front, s grows to the right and t upwards.
    let front = normals.iter().position(|normal| normal[2] > 0.9999).expect("a vertex in front");
    assert!(tangents[front][0] > 0.99 && bitangents[front][1] > 0.99 && tangents[front][3] == 1.0);
}

struct Nothing;

impl FileSource for Nothing {
    fn read(&self, _: &str) -> Result<Vec<u8>, FileError> {
        Err(FileError::Missing)
    }
}

#[test]
fn a_model_that_is_missing_is_an_error_of_files() {
    let loaded = load("no/such.obj", &Nothing, &compiler());
    assert!(loaded.io_error && loaded.scene.is_none());
    assert_eq!(told(&loaded), ["E0901: cannot read `no/such.obj`: there is no such file"]);
}

fn picture(folder: &Folder, scene: &str) -> (Image, String) {
    let output = folder.run(&["render", scene, "-o", "a.png"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    (Image::read(&fs::read(folder.path("a.png")).expect("written"), 4096, 1 << 24).expect("a PNG"), err(&output))
}

/// The pixels that are not as the first one, as the bounding box and their mean lightness.
fn seen(image: &Image) -> ([usize; 4], f32, f32) {
    let width = image.width as usize;
    let background = image.pixels[0];
    let (mut bounds, mut sum, mut count) = ([usize::MAX, usize::MAX, 0, 0], 0.0, 0);
    for (index, pixel) in image.pixels.iter().enumerate().filter(|(_, pixel)| **pixel != background) {
        let (x, y) = (index % width, index / width);
        bounds = [bounds[0].min(x), bounds[1].min(y), bounds[2].max(x), bounds[3].max(y)];
        sum += pixel[..3].iter().sum::<f32>() / 3.0;
        count += 1;
    }
    (bounds, sum / count.max(1) as f32, count as f32 / image.pixels.len() as f32)
}

#[test]
fn one_command_lights_a_model() {
    let names = ["vase.obj", "vase.mtl", "boxes.gltf", "boxes.glb"];
    let files: Vec<(&str, Vec<u8>)> = names.map(|name| (name, fixture(name))).into();
    let files: Vec<(&str, &[u8])> = files.iter().map(|(name, bytes)| (*name, bytes.as_slice())).collect();
    let folder = Folder::new(&files);
    for model in ["vase.obj", "boxes.gltf", "boxes.glb"] {
        let (image, said) = picture(&folder, model);
        let ([left, top, right, bottom], light, covered) = seen(&image);
        let (width, height) = (right - left, bottom - top);
        assert!(
            left > 4 && top > 4 && right < 507 && bottom < 507,
            "{model} is cut off: {left} {top} {right} {bottom}"
        );
        assert!(width.max(height) > 400, "{model} is small: {width}x{height}");
        assert!((0.2..0.9).contains(&light) && covered > 0.1, "{model}: {light} {covered}");
        assert!(!said.contains("note"), "{said}");
        // `new-scene` writes the scene of that picture.
        let made = folder.run(&["new-scene", model, "-o", "made.toml"]);
        assert_eq!(code(&made), 0, "{}", err(&made));
        assert!(picture(&folder, "made.toml").0 == image, "{model}: another picture");
        fs::remove_file(folder.path("made.toml")).expect("it was written");
    }
    // The vase stands: its mouth is above its foot and wider than its neck; its glaze is blue, its clay red.
    let (image, _) = picture(&folder, "vase.obj");
    let at = |x: usize, y: usize| image.pixels[y * 512 + x];
    let ([_, top, _, bottom], _, _) = seen(&image);
    let (glaze, clay) = (at(256, top + (bottom - top) / 6), at(256, bottom - (bottom - top) / 3));
    assert!(glaze[2] > glaze[0] && clay[0] > clay[2], "{glaze:?} {clay:?}");
}

#[test]
fn what_a_model_lacks_is_a_note() {
    let folder = Folder::new(&[("vase.obj", &fixture("vase.obj")), ("broken.obj", b"v 0 0 0\nf 1 2 3\n")]);
    let (_, said) = picture(&folder, "vase.obj");
    assert!(
        said.contains("W0912") && said.contains("the materials of `vase.mtl` are left out: there is no such file"),
        "{said}"
    );
    let output = folder.run(&["render", "broken.obj", "-o", "a.png"]);
    assert!(
        code(&output) == 1 && err(&output).contains("`broken.obj`: line 2: `2` names position 2"),
        "{}",
        err(&output)
    );
    let output = folder.run(&["render", "missing.glb", "-o", "a.png"]);
    assert!(code(&output) == 2 && err(&output).contains("cannot read `missing.glb`"), "{}", err(&output));
    let output = folder.run(&["new-scene", "missing.glb"]);
    assert_eq!(code(&output), 2);
}

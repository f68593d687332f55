//! Scene files that use the library: programs by name, lights and materials, textures by formula, and the diagnostics
//! for errors in them.

use crate::scenes::{the_error, told};
use crate::support::compiler;
use glisten::scene::{Loaded, MemoryFiles, load};
use glisten_front::diagnostic::Severity;
use glisten_front::hir::ScalarValue;
use glisten_verify::scene::{Draw, Texels, Wrap};

const GOOD: &str = r#"
global_ambient = [0.1, 0.2, 0.3]
[camera]
eye = [0, 0, 5]
[[light]]
kind = "directional"
towards = [0, 2, 0]
color = [1, 0.5, 0.25]
specular = [0, 0, 1]
[[light]]
kind = "spot"
position = [0, 3, 0]
target = [0, 1, 4]
exponent = 8
attenuation = [1, 0.5, 0.25]
ambient = [0.1, 0.1, 0.1]
[[light]]
kind = "hemisphere"
sky = [0.5, 0.6, 0.7]
ground = [0.3, 0.2, 0.1]
[material]
diffuse = [0.5, 0.25, 0.125]
specular = [1, 1, 1]
shininess = 20
specular_model = "schlick_blinn"
[[draw]]
program = "standard"
mesh = { shape = "sphere", segments = 8, rings = 4 }
transform = { translate = [1, 2, 3] }
"#;

const OWN_VERTEX: &str = "#version 150\nin vec3 place;\nvoid main() { gl_Position = vec4(place, 1.0); }\n";
const OWN_FRAGMENT: &str = "#version 150\n#extension GL_ARB_shading_language_include : require\n\
    #include <glisten/scene.glsl>\nout vec4 color;\n\
    void main() { color = vec4(light[0].position + light[0].diffuse * float(lights), material.shininess); }\n";

fn load_text(text: &str) -> Loaded {
    let files = MemoryFiles::new([("a.toml", text), ("own.vert", OWN_VERTEX), ("own.frag", OWN_FRAGMENT)]);
    load("a.toml", &files, &compiler().with_includes(glisten::library::Embedded))
}

/// The scene with `from` replaced.
fn changed(from: &str, to: &str) -> Loaded {
    assert!(GOOD.contains(from), "`{from}` is not in the scene");
    load_text(&GOOD.replacen(from, to, 1))
}

#[track_caller]
fn good(loaded: &Loaded) -> &Draw {
    assert!(loaded.diagnostics.is_empty(), "{:?}", told(loaded));
    &loaded.scene.as_ref().expect("without findings there is a scene").draws[0]
}

/// The only error of a changed scene, in the form of [`the_error`].
#[track_caller]
fn mistake(from: &str, to: &str) -> (&'static str, String, String) {
    the_error(&changed(from, to))
}

/// The numbers of a uniform.
#[track_caller]
pub(crate) fn value(draw: &Draw, name: &str) -> Vec<f32> {
    let interface = &draw.program.interface;
    let leaf = interface.uniforms.iter().find(|leaf| leaf.name == name).unwrap_or_else(|| panic!("no `{name}`"));
    let start = leaf.flat_offset as usize;
    let length = draw.program.types.flat_len(leaf.ty) as usize;
    let number = |value: &ScalarValue| match value {
        ScalarValue::Float(value) => *value,
        ScalarValue::Int(value) => *value as f32,
        other => panic!("{other:?}"),
    };
    draw.uniforms[leaf.root.0 as usize][start..start + length].iter().map(number).collect()
}

#[test]
fn lights_and_material_fill_the_uniforms() {
    let loaded = load_text(GOOD);
    let draw = good(&loaded);
    assert_eq!(value(draw, "lights"), [3.0]);
    assert_eq!(value(draw, "global_ambient"), [0.1, 0.2, 0.3]);
    // In the struct, the direction is that of the light's travel.
    assert_eq!((value(draw, "light[0].kind"), value(draw, "light[0].direction")), (vec![0.0], vec![0.0, -2.0, 0.0]));
    assert_eq!(value(draw, "light[0].diffuse"), [1.0, 0.5, 0.25]);
    assert_eq!(value(draw, "light[0].specular"), [0.0, 0.0, 1.0]);
    assert_eq!((value(draw, "light[1].kind"), value(draw, "light[1].direction")), (vec![2.0], vec![0.0, -2.0, 4.0]));
    assert_eq!(
        (value(draw, "light[1].exponent"), value(draw, "light[1].attenuation")),
        (vec![8.0], vec![1.0, 0.5, 0.25])
    );
    assert_eq!(value(draw, "light[2].kind"), [3.0]);
    assert_eq!(
        (value(draw, "light[2].diffuse"), value(draw, "light[2].ambient")),
        (vec![0.5, 0.6, 0.7], vec![0.3, 0.2, 0.1])
    );
    // The ambient reflectance defaults to the diffuse one.
    assert_eq!(value(draw, "material.ambient"), [0.5, 0.25, 0.125]);
    assert_eq!((value(draw, "material.shininess"), value(draw, "finish.specular_model")), (vec![20.0], vec![4.0]));
    assert_eq!(value(draw, "finish.diffuse_model"), [1.0]);
}

#[test]
fn programs_of_the_library_need_no_names() {
    let loaded = load_text(GOOD);
    let draw = good(&loaded);
    assert_eq!(value(draw, "model")[12..15], [1.0, 2.0, 3.0]);
    assert_eq!(value(draw, "eye"), [0.0, 0.0, 5.0]);
    assert!(draw.attributes.iter().all(Option::is_some));
    // A sampler without a texture is white.
    for texture in &draw.textures {
        let texture = texture.as_ref().expect("it has texels");
        assert_eq!(texture.levels[0].texels, Texels::Float(vec![[1.0; 4]]));
    }
    // The draw's own settings take precedence.
    let loaded =
        changed("[[draw]]", "[[draw]]\nmatrices = { model = \"view\" }\nuniforms = { \"material.shininess\" = 7 }");
    let draw = good(&loaded);
    assert_eq!((value(draw, "model")[14], value(draw, "material.shininess")[0]), (-5.0, 7.0));
    let files = "vertex = \"<glisten/programs/standard.vert>\"\nfragment = \"<glisten/programs/standard.frag>\"";
    good(&changed("program = \"standard\"", files));
}

#[test]
fn lights_go_to_eye_space_on_demand() {
    let loaded = changed("[[draw]]", "[[draw]]\nlight_space = \"eye\"");
    let draw = good(&loaded);
    assert_eq!(
        (value(draw, "light[1].position"), value(draw, "light[1].direction")),
        (vec![0.0, 3.0, -5.0], vec![0.0, -2.0, 4.0])
    );
}

#[test]
fn programs_of_ones_own_get_the_scenes_lights() {
    let own = "vertex = \"own.vert\"\nfragment = \"own.frag\"\nattributes = { place = { size = 3, values = [0,0,0, 1,0,0, 0,1,0] } }";
    let text = &GOOD[..GOOD.find("[[draw]]").expect("it draws")];
    let loaded = load_text(&format!("{text}[[draw]]\n{own}\n"));
    let draw = &loaded.scene.as_ref().expect("it loads").draws[0];
    assert_eq!((value(draw, "lights"), value(draw, "light[1].position")), (vec![3.0], vec![0.0, 3.0, 0.0]));
    assert_eq!(value(draw, "material.shininess"), [20.0]);
    // It has one light without a direction, and no reflectances.
    assert!(loaded.diagnostics.iter().all(|found| found.code.id == "W0911"), "{:?}", told(&loaded));
    let material = unread(&loaded).pop().expect("a warning about the material");
    assert_eq!(
        material.0,
        "the program `own.frag` does not read `diffuse`, `specular` and `specular_model` of the material"
    );
}

#[test]
fn a_draws_own_material_replaces_the_scenes() {
    let loaded = changed("[[draw]]", "[[draw]]\nmaterial = { emission = [1, 0, 0] }");
    let draw = good(&loaded);
    assert_eq!(
        (value(draw, "material.emission"), value(draw, "material.specular")),
        (vec![1.0, 0.0, 0.0], vec![0.0; 3])
    );
    let (code, place, text) = mistake("program = \"standard\"", "program = \"decal\"\nmaterial = {}");
    assert_eq!((code, place.as_str()), ("E0907", "material"));
    assert!(text.contains("glisten/scene.glsl"), "{text}");
}

#[test]
fn defines_are_macros_of_the_draws_program() {
    let more = "[[light]]\nkind = \"hemisphere\"\n".repeat(6);
    let (code, place, text) = mistake("[material]", &format!("{more}[material]"));
    assert_eq!(code, "E0908");
    assert!(place.starts_with("[[light]]"), "{place}");
    assert!(text.contains("9 lights") && text.contains("defines = { GLISTEN_LIGHTS = 9 }"), "{text}");
    let text = GOOD.replace("[material]", &format!("{more}[material]"));
    let loaded = load_text(&text.replace("[[draw]]", "[[draw]]\ndefines = { GLISTEN_LIGHTS = 9 }"));
    assert_eq!(value(good(&loaded), "lights"), [9.0]);
    assert_eq!(mistake("[[draw]]", "[[draw]]\ndefines = { \"1A\" = 1 }").0, "E0905");
    assert_eq!(mistake("[[draw]]", "[[draw]]\ndefines = { A = [1] }").0, "E0904");
    assert_eq!(mistake("[[draw]]", "[[draw]]\ndefines = { A = \"1\\n#error\" }").0, "E0905");
}

#[test]
fn mistakes_of_lights_name_the_nearest() {
    let (code, place, text) = mistake("kind = \"spot\"", "kind = \"spto\"");
    assert_eq!((code, place.as_str()), ("E0905", "\"spto\""));
    assert!(text.contains("did you mean `spot`?"), "{text}");
    let (code, place, text) = mistake("towards = [0, 2, 0]", "towards = [0, 2, 0]\nposition = [0, 0, 0]");
    assert_eq!((code, place.as_str()), ("E0903", "position"));
    assert!(text.contains("a directional light has no key `position`"), "{text}");
    let (code, _, text) = mistake("towards = [0, 2, 0]\n", "");
    assert!(code == "E0906" && text.contains("has no `towards`"), "{text}");
    let (code, _, text) = mistake("target = [0, 1, 4]\n", "");
    assert!(code == "E0906" && text.contains("has no `direction`"), "{text}");
    let (code, _, text) = mistake("kind = \"hemisphere\"\n", "");
    assert!(code == "E0906" && text.contains("names its kind"), "{text}");
    assert_eq!(mistake("exponent = 8", "exponent = \"8\"").0, "E0904");
    assert_eq!(mistake("sky = [0.5, 0.6, 0.7]", "sky = [0.5, 0.6]").0, "E0904");
    assert_eq!(mistake("[[draw]]", "[[draw]]\nlight_space = \"clip\"").0, "E0905");
}

#[test]
fn mistakes_of_materials_name_the_nearest() {
    let (code, place, text) = mistake("shininess = 20", "shinyness = 20");
    assert_eq!((code, place.as_str()), ("E0903", "shinyness"));
    assert!(text.contains("did you mean `shininess`?"), "{text}");
    let (code, _, text) = mistake("\"schlick_blinn\"", "\"blinn_pong\"");
    assert!(code == "E0905" && text.contains("did you mean `blinn_phong`?"), "{text}");
    let (code, _, text) = mistake("\"schlick_blinn\"", "\"table_half\"");
    assert!(code == "E0906" && text.contains("highlight = { pattern = \"specular\" }"), "{text}");
    good(&changed("\"schlick_blinn\"", "\"table_half\"\nhighlight = { pattern = \"specular\", exponent = 9 }"));
}

#[test]
fn mistakes_of_programs_name_the_nearest() {
    let (code, place, text) = mistake("program = \"standard\"", "program = \"standrad\"");
    assert_eq!((code, place.as_str()), ("E0905", "\"standrad\""));
    assert!(text.contains("did you mean `standard`?"), "{text}");
    let (code, place, _) = mistake("program = \"standard\"", "program = \"standard\"\nvertex = \"a.vert\"");
    assert_eq!((code, place.as_str()), ("E0905", "vertex"));
    let files = "vertex = \"<glisten/programs/standrad.vert>\"\nfragment = \"<glisten/programs/standard.frag>\"";
    let (code, _, text) = mistake("program = \"standard\"", files);
    assert!(code == "E0905" && text.contains("did you mean `<glisten/programs/standard.vert>`?"), "{text}");
}

#[test]
fn lights_that_no_program_asks_for_are_a_warning() {
    let loaded = changed("program = \"standard\"", "program = \"decal\"");
    assert!(loaded.scene.is_some());
    let codes: Vec<&str> = loaded.diagnostics.iter().map(|diagnostic| diagnostic.code.id).collect();
    assert_eq!(codes, ["W0904"; 3], "{:?}", told(&loaded));
}

/// The warnings about keys that nothing reads: message and help.
fn unread(loaded: &Loaded) -> Vec<(String, String)> {
    let found = loaded.diagnostics.iter().filter(|found| found.code.id == "W0911");
    found.map(|found| (found.message.clone(), found.help.clone().unwrap_or_default())).collect()
}

#[test]
fn keys_that_no_program_reads_are_told_by_name() {
    let with = |program: &str, model: &str| {
        let text = GOOD
            .replace("\"standard\"", &format!("\"{program}\""))
            .replace("\"schlick_blinn\"", &format!("\"{model}\""));
        load_text(&text)
    };
    good(&with("standard", "phong"));
    // A program has its own model; saying so is no mistake.
    good(&with("phong", "phong"));
    good(&with("schlick_vertex", "schlick_blinn"));
    let told = unread(&with("threshold", "threshold"));
    assert!(matches!(&told[..], [(message, _)] if message.contains("does not read `shininess`")), "{told:?}");
    let [(message, help)] = unread(&with("phong", "blinn_phong")).try_into().expect("one warning");
    assert_eq!(message, "the program `phong` does not read `specular_model` of the material");
    assert_eq!(help, "of the library, `standard` and `standard_vertex` read it");
    let told = unread(&with("lambert", "blinn_phong"));
    assert_eq!(told.len(), 2, "{told:?}");
    assert_eq!(told[0].0, "the program `lambert` does not read `specular` of the light");
    assert!(
        told[1].0.ends_with("does not read `shininess`, `specular` and `specular_model` of the material"),
        "{told:?}"
    );
    // What one of several programs reads is read.
    let two = GOOD.to_owned() + "[[draw]]\nprogram = \"lambert\"\nmesh = { shape = \"quad\" }\n";
    good(&load_text(&two));
    let own = two + "material = { emission = [1, 0, 0], shininess = 3, decal = { pattern = \"checker\" } }\n";
    let [(message, help)] = unread(&load_text(&own)).try_into().expect("one warning");
    assert_eq!(message, "the program `lambert` does not read `decal` and `shininess` of the material");
    assert_eq!(help, "of the library, `standard` and `standard_vertex` read them");
}

#[test]
fn textures_by_formula() {
    let with = |texture: &str| changed("[[draw]]", &format!("[[draw]]\ntextures = {{ highlight = {texture} }}"));
    let loaded = with("{ pattern = \"specular\", exponent = 2, width = 5 }");
    let slots = &good(&loaded).program.interface.samplers;
    let index = slots.iter().position(|slot| slot.name == "highlight").expect("declared");
    let texture = good(&loaded).textures[index].as_ref().expect("it has texels");
    let row = [0.0, 0.0625, 0.25, 0.5625, 1.0].map(|level| [level, level, level, 1.0]);
    assert_eq!((&texture.levels[0].texels, texture.wrap), (&Texels::Float(row.to_vec()), Wrap::ClampToEdge));
    good(&with("{ pattern = \"checker\", cells = 4, filter = \"trilinear\", mipmaps = true, wrap = \"clamp\" }"));
    for (texture, id, words) in [
        ("{ pattern = \"speculr\" }", "E0905", "did you mean `specular`?"),
        ("{ pattern = \"specular\", cells = 4 }", "E0905", "the pattern `specular` has no `cells`"),
        ("{ pattern = \"specular\", exponnt = 4 }", "E0903", "did you mean `exponent`?"),
        ("{ pattern = \"specular\", file = \"a.png\" }", "E0905", "a texture with `file` has no `pattern`"),
        ("{ pattern = \"specular\", values = [1, 1, 1, 1] }", "E0905", "a texture with `values` has no `pattern`"),
        ("{ pattern = \"specular\", width = 0 }", "E0905", "`width` must be 1 to"),
        ("{ exponent = 4, width = 1, height = 1, values = [1, 1, 1, 1] }", "E0903", "has no key `exponent`"),
    ] {
        let loaded = with(texture);
        assert!(loaded.scene.is_none(), "{texture} was accepted");
        let error = loaded.diagnostics.iter().find(|found| found.severity == Severity::Error).expect("an error");
        let text = format!("{} {}", error.message, error.help.as_deref().unwrap_or(""));
        assert!(error.code.id == id && text.contains(words), "{texture}: {} {text}", error.code);
    }
}

/// The complete scenes in the documentation.
#[test]
fn scenes_in_the_docs_load() {
    let mut seen = 0;
    for page in ["README.md", "docs/scenes.md"] {
        let text = std::fs::read_to_string(crate::support::root().join(page)).expect("readable");
        let blocks = text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
        for block in blocks.filter(|block| block.contains("program = \"standard\"")) {
            let loaded = load_text(block);
            assert!(loaded.scene.is_some() && loaded.diagnostics.is_empty(), "{page}: {:?}\n{block}", told(&loaded));
            seen += 1;
        }
    }
    assert_eq!(seen, 2);
}

#[test]
fn the_docs_list_every_program() {
    let text = std::fs::read_to_string(crate::support::root().join("docs/scenes.md")).expect("readable");
    for program in glisten::library::programs() {
        let row = format!("| `{}` | {} |", program.name, program.about);
        assert!(text.contains(&row), "docs/scenes.md lacks {row}");
    }
}

#[test]
fn image_files_are_decoded_on_demand() {
    use glisten_scene::picture::{Effort, png_rgb};
    let png = png_rgb(2, 1, &[[0, 188, 255], [10, 118, 255]], Effort::Fast).expect("a picture");
    let load = |decode: &str| {
        let texture = format!("textures = {{ decal = {{ file = \"a.png\"{decode} }} }}\n");
        let text = format!("[[draw]]\nprogram = \"decal\"\nmesh = {{ shape = \"quad\" }}\n{texture}");
        let files = MemoryFiles([("a.toml".into(), text.into_bytes()), ("a.png".into(), png.clone())].into());
        let loaded = load("a.toml", &files, &compiler().with_includes(glisten::library::Embedded));
        let draw = good(&loaded).clone();
        match &draw.textures[0].as_ref().expect("it has texels").levels[0].texels {
            Texels::Float(texels) => texels.clone(),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(load("")[0], [0.0, 188.0 / 255.0, 1.0, 1.0]);
    assert_eq!(load(", decode = \"linear\""), load(""));
    for (texel, wanted) in load(", decode = \"srgb\"").iter().zip([[0.0, 0.5029, 1.0], [0.00304, 0.1812, 1.0]]) {
        assert!(texel.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-4) && texel[3] == 1.0, "{texel:?}");
    }
    let loaded = changed("[[draw]]", "[[draw]]\ntextures = { decal = { pattern = \"checker\", decode = \"srgb\" } }");
    assert!(told(&loaded)[0].contains("`decode` is for an image file"), "{:?}", told(&loaded));
}

/// A material of glTF's: its color, metal and roughness say what is diffuse and what is mirrored, and that GGX mirrors it.
#[test]
fn metal_and_roughness_are_a_material() {
    let physical = "base_color = [0.5, 0.25, 1]\nmetallic = 0.5\nroughness = 0.25\nclearcoat = 0.75";
    let from = "diffuse = [0.5, 0.25, 0.125]\nspecular = [1, 1, 1]\nshininess = 20\nspecular_model = \"schlick_blinn\"";
    let loaded = changed(from, physical);
    let draw = good(&loaded);
    assert_eq!(value(draw, "material.diffuse"), [0.25, 0.125, 0.5]);
    assert_eq!(value(draw, "material.specular"), [0.27, 0.145, 0.52]);
    assert_eq!((value(draw, "finish.specular_model"), value(draw, "finish.roughness")), (vec![9.0], vec![0.25]));
    assert_eq!((value(draw, "finish.clearcoat"), value(draw, "finish.clearcoat_roughness")), (vec![0.75], vec![0.1]));
    // What is given takes precedence.
    let loaded = changed(from, &format!("{physical}\nspecular_model = \"beckmann\"\nspecular = [0.5, 0.5, 0.5]"));
    assert_eq!(value(good(&loaded), "finish.specular_model"), [10.0]);
    assert_eq!(value(good(&loaded), "material.specular"), [0.5; 3]);
    // A program without microfacets says so.
    let loaded = load_text(&GOOD.replace(from, "roughness = 0.5").replace("\"standard\"", "\"phong\""));
    assert!(told(&loaded).iter().any(|told| told.contains("`roughness`")), "{:?}", told(&loaded));
}

#[test]
fn a_framebuffer_has_a_tone_curve_and_an_exposure() {
    use glisten_scene::picture::Tone;
    let with = |keys: &str| {
        load_text(&format!("[framebuffer]\n{keys}\n{}", GOOD.trim_start_matches("\nglobal_ambient = [0.1, 0.2, 0.3]")))
    };
    let loaded = with("tonemap = \"agx\"\nexposure = -1.5\nencode = \"srgb\"");
    good(&loaded);
    let encode = loaded.scene.as_ref().expect("it loads").framebuffer.encode;
    assert_eq!((encode.tone, encode.exposure), (Tone::Agx, -1.5));
    let (_, place, message) = the_error(&with("tonemap = \"agy\""));
    assert!(place == "\"agy\"" && message.contains("agx"), "{place}: {message}");
    for keys in ["exposure = 65", "format = \"rgba32sint\"\ntonemap = \"aces\""] {
        assert!(with(keys).scene.is_none(), "{keys}");
    }
}

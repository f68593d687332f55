//! The layers of a material of the program `standard`: fibers, a brush, a film, a coat with textures, glass, and places of textures.

use crate::drawing::reference;
use crate::lit_scenes::value;
use crate::scenes::told;
use crate::support::compiler;
use glisten::scene::{Loaded, MemoryFiles, Scene, load};
use glisten_reference::Precision;
use std::f32::consts::PI;

/// A square that fills the window, seen from straight above and from far away, so that all pixels have the same eye.
pub(crate) fn scene(light: &str, draw: &str, material: &str) -> Loaded {
    let text = format!(
        "[framebuffer]\nwidth = 8\nheight = 8\n[camera]\neye = [0, 0, 4096]\northo = 1\nnear = 4095\nfar = 4097\n{light}\n[[draw]]\n\
         program = \"standard\"\nmesh = {{ shape = \"quad\" }}\n{draw}\n[draw.material]\n{material}\n"
    );
    let files = MemoryFiles::new([("a.toml", text.as_str())]);
    load("a.toml", &files, &compiler().with_includes(glisten::library::Embedded))
}

#[track_caller]
pub(crate) fn good(loaded: Loaded) -> Scene {
    assert!(loaded.diagnostics.is_empty(), "{:?}", told(&loaded));
    loaded.scene.expect("without findings there is a scene")
}

/// The colors of the pixels, row by row from below.
pub(crate) fn picture(scene: &Scene) -> Vec<[f64; 4]> {
    let drawn = reference(scene, Precision::F64);
    (0..64).map(|at| drawn.attachments[0][(7 - at / 8) * 8 + at % 8]).collect()
}

/// The color of a pixel in the middle.
pub(crate) fn middle(light: &str, material: &str) -> [f64; 4] {
    picture(&good(scene(light, "", material)))[36]
}

/// Light from everywhere, of intensity 1.
pub(crate) const DOME: &str = "[[light]]\nkind = \"hemisphere\"\nsky = [1, 1, 1]\nground = [1, 1, 1]";
/// Light from the eye.
pub(crate) const HEAD_ON: &str = "[[light]]\nkind = \"directional\"\ntowards = [0, 0, 1]";

#[track_caller]
pub(crate) fn near(found: [f64; 4], wanted: [f64; 3], within: f64) {
    let is_near = found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() <= within);
    assert!(is_near, "{found:?} {wanted:?}");
}

/// White surfaces return all of the light from everywhere, whatever lies on them.
#[test]
fn white_layers_are_white_in_white_light() {
    let plaster = "diffuse = [1, 1, 1]\nspecular_model = \"none\"\n";
    let plastic = "base_color = [1, 1, 1]\nmetallic = 0.0\nroughness = 0.5\n";
    let layers = [
        (plaster, "sheen = [1, 1, 1]\nsheen_roughness = 0.5"),
        (plaster, "sheen = [0.5, 0.5, 0.5]\nsheen_roughness = 1.0\nclearcoat = 1.0"),
        (plastic, "anisotropy = 0.8"),
        (plastic, "transmission = 1.0"),
        (plastic, "transmission = 0.5\nclearcoat = 0.5\nclearcoat_normal_scale = 2.0"),
        (plastic, "sheen = [1, 1, 1]\nsheen_roughness = 0.25\nanisotropy = 1.0\ntransmission = 0.25"),
    ];
    for (base, layer) in layers {
        let found = middle(DOME, &format!("{base}{layer}"));
        near(found, [1.0; 3], 2e-3);
    }
}

/// Seen and lit from straight above, the density of a brushed surface is 1 / (pi a_t a_b), and Smith's term is 1 / 4.
#[test]
fn a_brush_widens_the_highlight() {
    let metal = "base_color = [1, 0.5, 0.25]\nmetallic = 1.0\nroughness = 0.5\n";
    for strength in [0.0_f64, 0.5, 1.0] {
        let along = 0.25 + strength * strength * 0.75;
        let found = middle(HEAD_ON, &format!("{metal}anisotropy = {strength:?}\nanisotropy_rotation = 30"));
        let factor = 0.25 / (along * 0.25);
        near(found, [factor, 0.5 * factor, 0.25 * factor], 1e-5);
    }
    // Along the scratches, the light moves out of the highlight sooner than across them.
    let lit = |turn: f64| {
        let light = "[[light]]\nkind = \"directional\"\ntowards = [0.6, 0, 0.8]";
        middle(light, &format!("{metal}anisotropy = 1.0\nanisotropy_rotation = {turn:?}"))[0]
    };
    assert!(lit(0.0) > 2.0 * lit(90.0), "{} {}", lit(0.0), lit(90.0));
    assert!((lit(0.0) - lit(180.0)).abs() < 1e-6);
    // The texture turns the brush, too, and its blue is a part of the strength.
    let map = |texel: &str| {
        let light = "[[light]]\nkind = \"directional\"\ntowards = [0.6, 0, 0.8]";
        let map = format!("anisotropy_map = {{ width = 1, height = 1, values = [{texel}] }}");
        middle(light, &format!("{metal}anisotropy = 1.0\n{map}"))[0]
    };
    assert!((map("1, 0.5, 1, 1") - lit(0.0)).abs() < 1e-6);
    assert!((map("0.5, 1, 1, 1") - lit(90.0)).abs() < 1e-6);
    assert!(
        (map("1, 0.5, 0, 1") - middle("[[light]]\nkind = \"directional\"\ntowards = [0.6, 0, 0.8]", metal)[0]).abs()
            < 1e-6
    );
}

/// A film without thickness, or without strength, is none. Over a metal, one of a quarter of a wave takes green, and one of half a wave leaves it.
#[test]
fn a_film_has_colors() {
    let metal = "base_color = [0.5, 0.5, 0.5]\nmetallic = 1.0\nroughness = 0.5\n";
    let film = |more: &str| middle(HEAD_ON, &format!("{metal}{more}"));
    let bare = film("");
    near(film("iridescence = 1.0\niridescence_thickness = 0"), [bare[0], bare[1], bare[2]], 1e-6);
    near(film("iridescence = 0.0"), [bare[0], bare[1], bare[2]], 1e-6);
    // The path is 2 n d: half a wave of 550 nm, and a whole one.
    let [dark, bright] = [550.0 * 0.25 / 1.3, 550.0 * 0.5 / 1.3]
        .map(|thickness| film(&format!("iridescence = 1.0\niridescence_thickness = {thickness:?}")));
    assert!(
        bright[1] > 0.95 * bare[1] && dark[1] < 0.7 * bare[1] && bright[2] < 0.9 * bright[1],
        "{dark:?} {bare:?} {bright:?}"
    );
    // Maps: red is a part of the strength, green of the thickness.
    let map = "iridescence_thickness_map = { width = 1, height = 1, values = [0, 0.5, 0, 1] }";
    let found = film(&format!("iridescence = 1.0\niridescence_thickness = 300\niridescence_thinnest = 100\n{map}"));
    let wanted = film("iridescence = 1.0\niridescence_thickness = 200");
    near(found, [wanted[0], wanted[1], wanted[2]], 1e-9);
}

/// A light behind a thin wall shines through it as one before it is mirrored, by the wall's color and without what it absorbs.
#[test]
fn light_passes_through_glass() {
    let glass =
        "base_color = [0.5, 1, 0.25]\nmetallic = 0.0\nroughness = 0.5\ndielectric = [0, 0, 0]\ntransmission = 1.0\n";
    let behind = "[[light]]\nkind = \"directional\"\ntowards = [0, 0, -1]";
    let found = middle(behind, &format!("{glass}absorption = [0, 0, 0.5]"));
    let factor = f64::from(PI) * (1.0 / (f64::from(PI) * 0.0625)) * 0.25;
    near(found, [0.5 * factor, factor, 0.25 * factor * (-0.5_f64).exp()], 1e-5);
    // In front of a picture: the first draw multiplies, and the second one adds.
    let through =
        picture(&good(scene(HEAD_ON, "blend = \"multiply\"", &format!("{glass}transmission_pass = \"through\""))));
    near(through[36], [0.0; 3], 1e-9);
    let backed = "[framebuffer]\nclear = [1, 1, 1, 1]\nwidth = 8\nheight = 8\n[camera]\neye = [0, 0, 4096]\northo = 1\nnear = 4095\nfar = 4097\n[[draw]]\n\
                  program = \"standard\"\nmesh = { shape = \"quad\" }\nblend = \"multiply\"\n[draw.material]\n";
    let text = format!("{backed}{glass}transmission_pass = \"through\"\n");
    let files = MemoryFiles::new([("a.toml", text.as_str())]);
    let loaded = load("a.toml", &files, &compiler().with_includes(glisten::library::Embedded));
    near(picture(&loaded.scene.expect("it loads"))[36], [0.5, 1.0, 0.25], 1e-2);
}

/// The textures of a coat and of a dielectric are parts of the numbers.
#[test]
fn textures_of_the_coat_and_of_the_mirror_are_parts() {
    let plastic = "base_color = [0.25, 0.5, 0.75]\nmetallic = 0.0\nroughness = 0.5\n";
    let of = |more: &str| middle(HEAD_ON, &format!("{plastic}{more}"));
    let texel = |key: &str, texel: &str| format!("{key} = {{ width = 1, height = 1, values = [{texel}] }}\n");
    let pairs = [
        (
            "clearcoat = 1.0\nclearcoat_roughness = 0.8\n".to_owned()
                + &texel("clearcoat_map", "0.5, 0, 0, 1")
                + &texel("clearcoat_roughness_map", "0, 0.25, 0, 1"),
            "clearcoat = 0.5\nclearcoat_roughness = 0.2".to_owned(),
        ),
        (
            "dielectric = [0.08, 0.08, 0.08]\n".to_owned()
                + &texel("dielectric_map", "1, 0.5, 0.25, 1")
                + &texel("dielectric_strength_map", "0, 0, 0, 0.5"),
            "dielectric = [0.04, 0.02, 0.01]".to_owned(),
        ),
        (
            "sheen = [1, 0.5, 1]\nsheen_roughness = 1.0\n".to_owned()
                + &texel("sheen_map", "0.5, 1, 0, 1")
                + &texel("sheen_roughness_map", "0, 0, 0, 0.5"),
            "sheen = [0.5, 0.5, 0]\nsheen_roughness = 0.5".to_owned(),
        ),
    ];
    for (mapped, plain) in pairs {
        let [r, g, b, _] = of(&plain);
        near(of(&mapped), [r, g, b], 1e-6);
    }
    // A bump of the coat alone.
    let bump = texel("clearcoat_normal_map", "0.8, 0.5, 0.9, 1");
    let coat = "clearcoat = 1.0\nclearcoat_roughness = 0.3\n";
    let (flat, bumped) = (of(coat), of(&format!("{coat}{bump}")));
    assert!(bumped[0] < flat[0], "{bumped:?} {flat:?}");
    near(of(&format!("{coat}{bump}clearcoat_normal_scale = 0.0")), [flat[0], flat[1], flat[2]], 1e-6);
}

/// A transform scales, turns counterclockwise, and moves; each texture has its own.
#[test]
fn textures_have_their_places() {
    // Red and green below, blue and white above.
    let texture = "width = 2, height = 2, values = [1,0,0,1, 0,1,0,1, 0,0,1,1, 1,1,1,1], filter = \"nearest\"";
    let unlit = "diffuse_model = \"none\"\nspecular_model = \"none\"\ndiffuse = [0, 0, 0]\nemission = [1, 1, 1]\n";
    let drawn = |transform: &str| {
        let map = format!("emission_map = {{ {texture}, transform = {{ {transform} }} }}");
        let pixels = picture(&good(scene(HEAD_ON, "", &format!("{unlit}{map}"))));
        [pixels[9], pixels[14], pixels[49], pixels[54]].map(|[r, g, b, _]| [r, g, b])
    };
    let [red, green, blue, white] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
    assert_eq!(drawn("scale = 1"), [red, green, blue, white]);
    assert_eq!(drawn("translate = [0.5, 0]"), [green, red, white, blue]);
    assert_eq!(drawn("scale = 0.5"), [red; 4]);
    assert_eq!(drawn("scale = [0.5, 1]"), [red, red, blue, blue]);
    // The coordinates turn counterclockwise, and so the picture turns clockwise: the corner at (1, 0) goes to (0, 1).
    assert_eq!(drawn("rotate = 90, translate = [1, 0]"), [green, white, red, blue]);
    let loaded =
        good(scene(HEAD_ON, "", &format!("{unlit}emission_map = {{ {texture}, transform = {{ rotate = 90 }} }}")));
    assert_eq!(value(&loaded.draws[0], "places.decal.s"), [1.0, 0.0, 0.0]);
}

/// The map of light from all around: squares of one texel, the upper one for a roughness of 1.
fn around(smooth: f64, rough: f64) -> String {
    let texel = |level: f64| format!("{level:?}, {level:?}, {level:?}, 1");
    format!("[environment]\nwidth = 1\nheight = 2\nvalues = [{}, {}]\n", texel(smooth), texel(rough))
}

/// White surfaces in white surroundings are white; a matte one shows the roughest light, a mirror the smoothest.
#[test]
fn an_environment_is_light_from_all_around() {
    let plastic = "base_color = [1, 1, 1]\nmetallic = 0.0\nroughness = 0.5\n";
    for layer in
        ["", "clearcoat = 1.0", "sheen = [1, 1, 1]\nsheen_roughness = 0.5", "transmission = 1.0\nrefraction = 1.5"]
    {
        near(middle(&around(1.0, 1.0), &format!("{plastic}{layer}")), [1.0; 3], 2e-3);
    }
    let plaster = "diffuse = [0.5, 0.25, 1]\nspecular_model = \"none\"\n";
    near(middle(&around(1.0, 0.5), plaster), [0.25, 0.125, 0.5], 1e-6);
    let mirror = "base_color = [1, 0.5, 0.25]\nmetallic = 1.0\nroughness = 0.0\n";
    near(middle(&around(4.0, 0.5), mirror), [4.0, 2.0, 1.0], 2e-2);
    // Lights of the scene add to it.
    let lit = middle(&format!("{}{HEAD_ON}", around(1.0, 0.5)), plaster);
    near(lit, [0.75, 0.375, 1.5], 1e-6);
    // Its map is that of a scene; anything else is told.
    let texel = "width = 2\nheight = 3\nvalues = [0, 0, 0, 0,  0, 0, 0, 0,  0, 0, 0, 0,  0, 0, 0, 0,  0, 0, 0, 0,  0, 0, 0, 0]\n";
    let wrong = told(&scene(&format!("[environment]\n{texel}"), "", plaster)).join("\n");
    assert!(wrong.contains("2x3 texels has no squares"), "{wrong}");
    let unread = "[environment]\nwidth = 1\nheight = 1\nvalues = [1, 1, 1, 1]\n[[draw]]\nprogram = \"vertex_color\"\n\
                  attributes = { pv = { size = 3, values = [0, 0, 0] }, cv = { size = 3, values = [1, 1, 1] } }\nuniforms = { mc = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1] }\n";
    let files = MemoryFiles::new([("a.toml", unread)]);
    let loaded = load("a.toml", &files, &compiler().with_includes(glisten::library::Embedded));
    assert!(told(&loaded).join("\n").contains("declares a sampler `environment`"), "{:?}", told(&loaded));
}

/// A body shows what is behind it: all of white surroundings but for what it absorbs on its way, which is as long as it is thick in the middle.
#[test]
fn a_body_absorbs_and_bends_light() {
    let body =
        "base_color = [1, 1, 1]\nmetallic = 0.0\nroughness = 0.0\ndielectric_strength = 0.0\ntransmission = 1.0\n";
    let found = middle(&around(1.0, 1.0), &format!("{body}refraction = 1.5\nabsorption = [0, 0.5, 2]"));
    near(found, [1.0, (-0.5_f64).exp(), (-2.0_f64).exp()], 1e-3);
    // A hemisphere is seen through it, too: straight through is the ground.
    let dome = "[[light]]\nkind = \"hemisphere\"\naxis = [0, 0, 1]\nsky = [1, 0, 0]\nground = [0, 1, 0]";
    near(middle(dome, &format!("{body}refraction = 1.5")), [0.0, 1.0, 0.0], 1e-3);
    // Glass of the index of air blurs nothing, whatever its roughness.
    let rough = |index: &str| {
        let frosted = body.replace("roughness = 0.0", "roughness = 1.0");
        middle(&around(1.0, 0.25), &format!("{frosted}refraction = {index}"))[0]
    };
    assert!(
        (rough("1.0") - 1.0).abs() < 1e-3 && (rough("1.5") - 0.25).abs() < 1e-3 && (rough("1.25") - 0.625).abs() < 1e-3
    );
}

/// A leaf passes light on without a direction: of a light behind it, its color's part.
#[test]
fn a_leaf_scatters_light_through_itself() {
    let leaf = "base_color = [1, 1, 1]\nmetallic = 0.0\ndielectric_strength = 0.0\ndiffuse_transmission = 0.75\n\
                diffuse_transmission_color = [1, 0.5, 0.25]\n";
    let behind = "[[light]]\nkind = \"directional\"\ntowards = [0, 0.6, -0.8]";
    near(middle(behind, leaf), [0.6, 0.3, 0.15], 1e-6);
    near(middle(HEAD_ON, leaf), [0.25; 3], 1e-6);
    near(middle(DOME, leaf), [1.0, 0.625, 0.4375], 1e-6);
    let map = "diffuse_transmission_map = { width = 1, height = 1, values = [1, 1, 1, 0.5] }\n\
               diffuse_transmission_color_map = { width = 1, height = 1, values = [0, 1, 1, 1] }\n";
    near(middle(behind, &format!("{leaf}{map}")), [0.0, 0.15, 0.075], 1e-6);
    let metal = leaf.replace("metallic = 0.0", "metallic = 1.0");
    assert_eq!(middle(behind, &metal)[..3], [0.0; 3]);
}

/// The strength of what a dielectric mirrors is one for all angles (KHR_materials_specular scales F_90, too); a metal has all of it.
#[test]
fn the_strength_of_a_dielectric_is_that_at_grazing_angles_too() {
    let grazing = "[[light]]\nkind = \"directional\"\ntowards = [0, 0.9998, 0.02]";
    let plastic = "base_color = [0, 0, 0]\nmetallic = 0.0\nroughness = 0.6\n";
    let of = |more: &str| middle(grazing, &format!("{plastic}{more}"))[0];
    let whole = of("");
    assert!(whole > 0.0);
    for strength in [0.0, 0.25, 0.5, 1.0] {
        let found = of(&format!("dielectric_strength = {strength:?}"));
        assert!((found - strength * whole).abs() < 1e-9 + 1e-6 * whole, "{strength}: {found} {whole}");
    }
    let metal = "base_color = [1, 0.5, 0.25]\nmetallic = 1.0\nroughness = 0.6\n";
    let [r, g, b, _] = middle(HEAD_ON, metal);
    near(middle(HEAD_ON, &format!("{metal}dielectric_strength = 0.0")), [r, g, b], 1e-6);
    // White surroundings: what is not mirrored is left for the body.
    let white = "base_color = [1, 1, 1]\nmetallic = 0.0\nroughness = 0.5\n";
    near(middle(DOME, &format!("{white}dielectric_strength = 0.5")), [1.0; 3], 2e-3);
}

/// Mistakes have their messages.
#[test]
fn mistakes_in_layers_are_told() {
    let plain = "base_color = [1, 1, 1]\n";
    let texture = "width = 1, height = 1, values = [1, 1, 1, 1]";
    for (material, words) in [
        ("sheen_roughnes = 1", "no key `sheen_roughnes`"),
        ("transmission_pass = \"front\"", "`transmission_pass` cannot be `front`"),
        ("sheen = 1", "sheen"),
        ("anisotropy_map = 1", "anisotropy_map"),
        (&format!("decal = {{ {texture}, transform = {{ scale = [1, 2, 3] }} }}"), "scale"),
        (&format!("decal = {{ {texture}, transform = {{ scal = 1 }} }}"), "no key `scal`"),
        (&format!("decal = {{ {texture}, transform = 3 }}"), "transform"),
        (&format!("ramp = {{ {texture}, transform = {{ scale = 2 }} }}"), "nothing reads the `transform` of `ramp`"),
    ] {
        let found = told(&scene(HEAD_ON, "", &format!("{plain}{material}"))).join("\n");
        assert!(found.contains(words), "{material}: {found}");
    }
    // Draws' own textures have no places.
    let own = format!("textures = {{ decal = {{ {texture}, transform = {{ scale = 2 }} }} }}");
    let found = told(&scene(HEAD_ON, &own, plain)).join("\n");
    assert!(found.contains("W0911") && found.contains("nothing reads the `transform`"), "{found}");
}

/// Scratches are lines on the surface: seen from behind, those of 45 degrees are those of -45 degrees seen from the front.
#[test]
fn a_brush_is_the_same_line_from_both_sides() {
    let lit = |draw: &str, turn: f64| {
        let light = "[[light]]\nkind = \"directional\"\ntowards = [0.4, 0.4, 0.8]";
        let metal = "base_color = [1, 1, 1]\nmetallic = 1.0\nroughness = 0.5\nanisotropy = 1.0\ntwo_sided = true\n";
        picture(&good(scene(light, draw, &format!("{metal}anisotropy_rotation = {turn:?}"))))[36]
    };
    let turned = "transform = { rotate = [180, 1, 0, 0] }";
    for turn in [45.0, 20.0, -70.0] {
        let [behind, front, mirrored] = [lit(turned, turn), lit("", -turn), lit("", turn)];
        near(behind, [front[0], front[1], front[2]], 1e-5);
        assert!((front[0] - mirrored[0]).abs() > 0.05, "{front:?} {mirrored:?}");
    }
}

/// The coat is over the light that the surface sends out.
#[test]
fn emission_is_under_the_coat() {
    for (coat, wanted) in [(0.0, 1.0), (0.5, 0.98), (1.0, 0.96)] {
        let found = middle(
            "",
            &format!("diffuse = [0, 0, 0]\nemission = [1, 0.5, 0.25]\nclearcoat = {coat:?}\nroughness = 0.5"),
        );
        near(found, [wanted, 0.5 * wanted, 0.25 * wanted], 1e-6);
    }
}

/// At 80 degrees, a mirror of GGX has pi D V N.L F, and F goes to 1 whatever the reflectance at normal incidence is.
#[test]
fn all_is_mirrored_at_grazing_angles() {
    let cosine = 80.0_f64.to_radians().cos();
    let square = 0.25_f64 * 0.25;
    let visible = 0.5 / (2.0 * cosine * (cosine * cosine * (1.0 - square) + square).sqrt());
    let grazing = (1.0 - cosine).powi(5);
    for base in [0.0, 0.001, 0.01, 0.04] {
        let light = "[[light]]\nkind = \"directional\"\ntowards = [0.3420201433256687, 0, -0.9396926207859084]";
        let draw = "transform = { rotate = [80, 0, 1, 0], scale = 8 }";
        let material =
            format!("base_color = [0, 0, 0]\nmetallic = 0.0\nroughness = 0.5\ndielectric = [{base}, {base}, {base}]");
        let found = picture(&good(scene(light, draw, &material)))[36];
        let wanted = visible / square * cosine * (base + (1.0 - base) * grazing);
        near(found, [wanted; 3], 2e-2);
    }
    // A color that the scene states is none of glTF's: a black one mirrors nothing.
    let matte = "diffuse = [0, 0, 0]\nspecular = [0, 0, 0]\nspecular_model = \"ggx\"\nroughness = 0.5";
    near(middle(HEAD_ON, matte), [0.0; 3], 1e-9);
}

/// A key with the value that it has without it changes nothing, whatever program it chooses.
#[test]
fn neutral_keys_change_no_picture() {
    let light = "[[light]]\nkind = \"directional\"\ntowards = [0.6, 0, 0.8]\nambient = [0.25, 0.5, 1]";
    let white = "{ width = 1, height = 1, values = [1, 1, 1, 1] }";
    for base in [
        "base_color = [1, 0.5, 0.2]\nmetallic = 0.5\nroughness = 0.5\n",
        "base_color = [1, 0.5, 0.2]\nmetallic = 0.25\nambient = [0.1, 0.2, 0.3]\nemission = [0.1, 0, 0]\n",
        "diffuse = [0.5, 0.25, 0.1]\nspecular = [0.5, 0.5, 0.5]\nambient = [0.1, 0.2, 0.3]\n",
    ] {
        let bare = middle(light, base);
        let maps = ["occlusion_map", "emission_map", "metallic_roughness"].map(|map| format!("{map} = {white}"));
        let keys =
            ["two_sided = true", "iridescence = 0.0", "iridescence = 1e-12", "sheen = [0, 0, 0]", "transmission = 0.0"];
        for key in keys.into_iter().chain(maps.iter().map(String::as_str)) {
            let found = middle(light, &format!("{base}{key}"));
            assert!(
                found.iter().zip(bare).all(|(found, bare)| (found - bare).abs() < 1e-6),
                "{key}: {found:?} {bare:?}"
            );
        }
    }
}

/// Occlusion takes ambient light, whichever light it is of.
#[test]
fn occlusion_takes_the_ambient_light_of_lights() {
    let light = "[[light]]\nkind = \"directional\"\ntowards = [0, 0, 1]\ncolor = [0, 0, 0]\nambient = [1, 0.5, 0.25]";
    let material = |red: f64| {
        format!("diffuse = [0.5, 0.5, 0.5]\nocclusion_map = {{ width = 1, height = 1, values = [{red:?}, 0, 0, 1] }}")
    };
    for red in [0.0, 0.5, 1.0] {
        near(middle(light, &material(red)), [0.5 * red, 0.25 * red, 0.125 * red], 1e-6);
    }
}

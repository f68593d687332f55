//! `docs/seeds.md`: its numbers, and that comments name no register of a program that the article does not print.

use super::{call, function};
use crate::support::root;
use glisten_library::{shader, shader_files};

fn page() -> String {
    std::fs::read_to_string(root().join("docs/seeds.md")).expect("the page is there")
}

/// The article prints two programs; of the registers of all others it says nothing.
#[test]
fn only_the_printed_programs_name_registers() {
    let register = |word: &str| {
        let number = word.strip_prefix('c').or(word.strip_prefix("oD")).or(word.strip_prefix("oT"));
        number.is_some_and(|digits| !digits.is_empty() && digits.chars().all(|digit| digit.is_ascii_digit()))
    };
    for file in shader_files().filter(|file| !["hemisphere.vert", "soft.vert"].contains(file)) {
        let text = shader(file).expect("it is embedded");
        for line in text.lines().filter_map(|line| line.split_once("//")) {
            let found = line.1.split(|letter: char| !letter.is_ascii_alphanumeric()).find(|word| register(word));
            assert_eq!(found, None, "{file}: {}", line.1);
        }
    }
}

/// The example of the gate: light at 100 degrees from the normal, the eye at -10.
#[test]
fn the_half_vector_is_before_a_surface_that_the_light_is_behind() {
    let [light, eye] = [100.0f64, -10.0].map(f64::to_radians);
    let rows: Vec<f32> = [light.sin(), light.cos(), 0.0, eye.sin(), eye.cos(), 0.0].map(|x| x as f32).to_vec();
    let half = call(&function("blinn_phong", "halfVector(vec3,vec3)", &[]), &rows);
    let cosine = format!("{:.2}", half[0][1]);
    assert!(page().contains(&format!("N·H = {cosine}.")), "N·H = {cosine}");
}

/// The mistakes that the page must name: a part of each.
#[test]
fn the_page_names_every_mistake() {
    let page = page();
    for part in [
        "| (84), (86), (89) |",
        "| (87) |",
        "is a choice",
        "L_emi has no introduction",
        "放射面積",
        "頂点法線ベクトル",
        "| from (107) to (108) |",
        "Figure 138",
        "求ること",
        "次のようにになります",
        "物体内部の物体内部での",
        "変えるもの",
        "as the value of U",
        "have the resolution of floats",
        "hemisphere, first formula",
        "in the space of the *mesh*",
        "prints two of them",
    ] {
        assert!(page.contains(part), "{part}");
    }
    for part in ["2002", "without powers", "eight register-level programs)"] {
        assert!(!page.contains(part), "{part}");
    }
}

//! The account of scenes, its page, and the contracts that may change rounding, end to end.

use super::{bits, load, scene_files};
use crate::support::root;
use glisten_front::hir::Stage;
use glisten_reference::Precision;
use glisten_report::account::{SceneOnPage, page};
use glisten_scene::Scene;
use glisten_verify::specialize::{Contract, Math, account, picture_error, pictures, specialize_scene_by};
use std::path::Path;

const BOTH: Contract = Contract { math: Math::Fast, move_to_vertex: true };

fn page_of(name: &str, contract: Contract) -> (String, serde_json::Value) {
    page_of_file(&root().join("fixtures/scenes").join(name), contract)
}

fn page_of_file(path: &Path, contract: Contract) -> (String, serde_json::Value) {
    let (scene, sources) = load(path).expect("a scene");
    let specialized = specialize_scene_by(contract, &scene, &sources, &[]);
    let names: Vec<[String; 3]> = scene.draws.iter().map(|_| ["a.vert".into(), "a.frag".into(), "a".into()]).collect();
    let account = account("<scene>", &scene, &specialized, &names).expect("it can be drawn");
    let pictures = pictures(&scene, &specialized.scene, Precision::F32).expect("it can be drawn");
    let on_page = SceneOnPage {
        account: &account,
        scene: &scene,
        sources: &sources,
        specialized: &specialized,
        pictures: &pictures,
    };
    let page = page(&[on_page]).expect("the template is good");
    // Every line of the residual is on the page.
    for text in specialized.draws.iter().flat_map(|draw| &draw.texts) {
        let shown = page.matches("class=\"right\">").count() - page.matches("class=\"right\"></code>").count();
        let lines = text.1.lines().filter(|line| !line.is_empty()).count();
        assert!(shown >= lines, "{shown} of {lines} lines of the {} stage", text.0.name());
    }
    (page, serde_json::to_value(&account).expect("an account is JSON"))
}

#[test]
fn the_page_is_whole_and_alone() {
    let (page, account) = page_of("phong.toml", Contract::default());
    assert!(page.contains("&lt;scene&gt;") && page.contains("every bit of every pixel is the same"));
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 1, "no picture of nothing");
    // What went is struck through, with its reason for the pointer and for the keyboard.
    assert!(
        page.contains("<del>") && page.contains("tabindex=\"0\"") && page.contains("role=\"tooltip\">it is 2</span>")
    );
    for outside in ["http://", "https://", "src=\"/", "<link", "@import", "url(", "fetch("] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(account["fast_math"].is_null() && account["draws"][0]["move_to_vertex"].is_null(), "{account}");
}

/// The page of a scene whose shaders have a heading, by a later version.
fn page_with_heading() -> String {
    let vertex = "#version 330 core\n// Phong shading tutorial, 2012\nlayout(location = 0) in vec4 position;\n\
        /* of the host */\nuniform mat4 m;\nvoid main() {\n    // to clip space\n    gl_Position = m * position;\n}\n";
    let fragment = "#version 330 core\nuniform vec4 u;\nout vec4 color;\nvoid main() { color = u; }\n";
    let scene = "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nprimitive = \"triangles\"\n\
        vertex_count = 3\n[draw.attributes]\nposition = { size = 4, values = [-1, -1, 0, 1, 3, -1, 0, 1, -1, 3, 0, 1] }\n\
        [draw.uniforms]\nm = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\nu = [1, 0.5, 0.25, 1]\n";
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in [("a.vert", vertex), ("a.frag", fragment), ("a.toml", scene)] {
        std::fs::write(folder.path().join(name), text).expect("written");
    }
    page_of_file(&folder.path().join("a.toml"), Contract::default()).0
}

#[test]
fn a_heading_that_is_kept_is_not_new() {
    let page = page_with_heading();
    let rows: Vec<&str> =
        page.split("<div class=\"row ").skip(1).map(|row| row.split("</div>").next().unwrap_or("")).collect();
    for kept in ["Phong shading tutorial, 2012", "to clip space"] {
        let found: Vec<&&str> = rows.iter().filter(|row| row.contains(kept)).collect();
        assert!(!found.is_empty() && found.iter().all(|row| row.starts_with("same")), "{kept}: {found:?}");
    }
    assert!(
        rows.iter()
            .any(|row| row.starts_with("changed") && row.contains("#version 330 core") && row.contains("#version 150")),
        "{rows:#?}"
    );
    assert!(page.contains("The residual is written as GLSL 150") && page.contains("the original (330 core)"));
}

#[test]
fn a_contract_tells_its_error() {
    let (page, account) = page_of("phong.toml", BOTH);
    assert!(page.contains("Rounding was allowed to change."));
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 3);
    for error in [&account["fast_math"], &account["draws"][0]["fast_math"], &account["move_to_vertex"]] {
        let number = |key: &str| error[key].as_f64().unwrap_or(f64::NAN);
        assert!(number("max_abs") > 0.0 && number("max_abs") < 1e-4, "{error}");
        assert!(number("rmse") <= number("max_abs") && error["residual"]["max_abs"].is_number(), "{error}");
    }
    assert!(account["draws"][0]["move_to_vertex"]["moved"].is_array(), "{account}");
}

/// Fast math and moves may change rounding, and nothing that is seen.
#[test]
fn scenes_draw_nearly_the_same_under_both_contracts() {
    let (mut wrong, mut n_checked, mut n_moved) = (Vec::new(), 0, 0);
    for path in scene_files().iter().step_by(9) {
        let Some((scene, sources)) = load(path) else { continue };
        let specialized = specialize_scene_by(BOTH, &scene, &sources, &[]);
        n_moved += specialized.draws.iter().map(|draw| draw.moved.len()).sum::<usize>();
        let name = path.display();
        for draw in &specialized.draws {
            wrong.extend(draw.fault.as_ref().map(|fault| format!("{name}: {fault}")));
        }
        let Ok(error) = picture_error(&scene, &specialized.scene) else { continue };
        n_checked += 1;
        // Noise of `fract(sin(x) * 143.7)` is another one in f64, too: the original is as far off.
        let is_open = error.original.max_abs > 1e-2 && error.residual.max_abs < 2.0 * error.original.max_abs;
        if error.max_abs > 1e-2 && !is_open || error.non_finite > 0 {
            let text = specialized.draws.first().map_or("", |draw| draw.text(Stage::Fragment));
            wrong.push(format!("{name}: {error:?}\n{text}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {n_checked} scenes:\n{}", wrong.len(), wrong.join("\n"));
    assert!(n_checked > 10 && n_moved > 0, "{n_checked} scenes, {n_moved} moves");
}

/// The uniforms that the vertex stages of a scene read, by the names of their declarations: what a camera that moves changes.
fn of_the_camera(scene: &Scene) -> Vec<String> {
    let roots = scene.draws.iter().flat_map(|draw| &draw.program.interface.roots);
    let read = roots.filter(|root| root.globals.iter().any(|(stage, _)| *stage == Stage::Vertex));
    read.map(|root| root.name.clone()).collect()
}

/// Finite math changes no bit of a picture without infinities, and leaves out more where the camera moves.
#[test]
fn finite_math_draws_the_same_bits_and_leaves_out_more() {
    let (mut wrong, mut n_checked, mut n_shorter) = (Vec::new(), 0, 0);
    for path in scene_files().iter().step_by(7) {
        let Some((scene, sources)) = load(path) else { continue };
        let dynamic = of_the_camera(&scene);
        let by = |math| specialize_scene_by(Contract { math, ..Contract::default() }, &scene, &sources, &dynamic);
        let (exact, finite) = (by(Math::Exact), by(Math::Finite));
        let name = path.display();
        wrong.extend(finite.draws.iter().filter_map(|draw| Some(format!("{name}: {}", draw.fault.as_ref()?))));
        let (Ok(before), Ok(after)) = (bits(&scene), bits(&finite.scene)) else { continue };
        n_checked += 1;
        n_shorter += usize::from(finite.is_shorter_than(&exact.scene));
        if before != after {
            wrong.push(format!("{name}: {:?}", picture_error(&scene, &finite.scene)));
        }
    }
    assert!(wrong.is_empty(), "{} of {n_checked} scenes:\n{}", wrong.len(), wrong.join("\n"));
    assert!(n_checked > 20 && n_shorter > 0, "{n_checked} scenes, {n_shorter} of them shorter");
}

#[test]
fn the_account_of_finite_math_tells_its_error() {
    let (page, account) = page_of("phong.toml", Contract { math: Math::Finite, ..Contract::default() });
    assert!(
        page.contains("every bit of every pixel is the same") && page.contains("Every number was taken to be finite.")
    );
    for error in [&account["finite_math"], &account["draws"][0]["finite_math"]] {
        assert!(error["max_abs"] == 0.0 && error["pixels"] == 0 && error["original"]["max_abs"].is_number(), "{error}");
    }
    assert!(account["fast_math"].is_null(), "{account}");
}

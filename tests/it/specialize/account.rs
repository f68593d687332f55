//! The account of scenes, its page, and the contracts that may change rounding, end to end.

use super::{load, scene_files};
use crate::support::root;
use glisten::account::{SceneOnPage, page};
use glisten::specialize::{Contract, account, picture_error, pictures, specialize_scene_by};
use glisten_front::hir::Stage;
use glisten_reference::Precision;

const BOTH: Contract = Contract { fast_math: true, move_to_vertex: true };

fn page_of(name: &str, contract: Contract) -> (String, serde_json::Value) {
    let (scene, sources) = load(&root().join("fixtures/scenes").join(name)).expect("a scene");
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
    assert!(page.contains("&lt;scene&gt;") && page.contains("Every bit of every pixel is the same"));
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 3);
    // What went is struck through, with its reason for the pointer and for the keyboard.
    assert!(
        page.contains("<del>") && page.contains("tabindex=\"0\"") && page.contains("role=\"tooltip\">it is 2</span>")
    );
    for outside in ["http://", "https://", "src=\"/", "<link", "@import", "<script"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(account["fast_math"].is_null() && account["draws"][0]["move_to_vertex"].is_null(), "{account}");
}

#[test]
fn a_contract_tells_its_error() {
    let (page, account) = page_of("phong.toml", BOTH);
    assert!(page.contains("Rounding was allowed to change."));
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
        if error.max_abs > 1e-2 || error.non_finite > 0 {
            let text = specialized.draws.first().map_or("", |draw| draw.text(Stage::Fragment));
            wrong.push(format!("{name}: {error:?}\n{text}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {n_checked} scenes:\n{}", wrong.len(), wrong.join("\n"));
    assert!(n_checked > 10 && n_moved > 0, "{n_checked} scenes, {n_moved} moves");
}

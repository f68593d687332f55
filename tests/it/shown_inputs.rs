//! Findings on numerics name inputs that show them, and what no run shows is not told.

use crate::cli::{Folder, code, out};
use serde_json::Value;

const HEAD: &str =
    "#version 150\nin vec3 n; in vec3 l; in vec3 v; in float x; uniform float k; uniform sampler2D t; out vec4 c;\n";

/// The shader with this body.
fn shader(body: &str) -> String {
    format!(
        "{HEAD}void main() {{ vec3 N = normalize(n), L = normalize(l), V = normalize(v); float r = 0.0; {body} c = vec4(r) + \
         texture(t, x + N.xy + L.xy + V.xy); }}\n"
    )
}

/// The codes of numerics in a shader, each with its first note.
fn told(text: &str, config: &str) -> Vec<(String, String)> {
    let folder = Folder::new(&[("a.frag", text.as_bytes()), ("glisten.toml", config.as_bytes())]);
    let (findings, _) = folder.lint(&["a.frag"]);
    let of = |row: &Value| {
        let code = row["code"].as_str()?;
        let is_judged = matches!(code, "L0028" | "L0029" | "L0030" | "L0031" | "L0032" | "L0033" | "L0074");
        is_judged.then(|| (code.to_owned(), row["notes"].to_string()))
    };
    findings.iter().filter_map(of).collect()
}

#[test]
fn each_finding_names_inputs_that_show_it() {
    for (body, code) in [
        ("r = pow(dot(N, L), k);", "L0028"),
        ("r = pow(sin(x) * 0.5, 2.0);", "L0028"),
        ("r = pow(1.0 - dot(N, V), 5.0);", "L0028"),
        ("float d = dot(N, reflect(-L, N)); r = pow(d, k);", "L0028"),
        ("float d = dot(N, L); r = sqrt(1.0 - d * d);", "L0029"),
        ("r = inversesqrt(cos(x));", "L0029"),
        ("r = acos(dot(N, L));", "L0030"),
        ("r = log2(fract(x));", "L0031"),
        ("r = x / (4.0 * max(dot(N, L), 0.0));", "L0032"),
        ("r = normalize(n - n).x;", "L0033"),
    ] {
        let found = told(&shader(body), "");
        assert_eq!(found.len(), 1, "{body}: {found:?}");
        assert_eq!(found[0].0, code, "{body}");
        assert!(found[0].1.contains("the reference computes it so"), "{body}: {}", found[0].1);
    }
}

#[test]
fn what_the_stated_ranges_rule_out_is_not_told() {
    let text = shader("r = pow(dot(N, vec3(0.0, 0.0, 1.0)), k);");
    assert_eq!(told(&text, "").len(), 1);
    assert_eq!(told(&text, "[lint.ranges]\nn = [0.1, 1]\n"), []);
    let commented = text.replace("in vec3 n; ", "in vec3 n; // glisten: range(0.1, 1)\n");
    assert_eq!(told(&commented, ""), []);
}

#[test]
fn stated_ranges_lead_to_what_is_not_finite_in_them() {
    let text = shader("r = 1.0 / (k - 0.5);");
    assert_eq!(told(&text, ""), [], "nothing is stated");
    let found = told(&text, "[lint.ranges]\nk = [0, 1]\n");
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].0, "L0074");
    assert!(found[0].1.contains("`k` = 0.5"), "{}", found[0].1);
    assert_eq!(told(&text, "[lint.ranges]\nk = [0.75, 1]\n"), []);
    let vertex = "#version 150\nin vec3 p; // glisten: range(-1, 1)\nout float y;\nvoid main() { y = inversesqrt(p.x); gl_Position = vec4(p, 1.0); }\n";
    let folder = Folder::new(&[("a.vert", vertex.as_bytes())]);
    let (findings, _) = folder.lint(&["a.vert"]);
    assert!(findings.iter().any(|one| one["code"] == "L0074" && one["line"] == 4), "{findings:?}");
}

#[test]
fn ranges_that_mean_nothing_are_told() {
    let folder = Folder::new(&[
        ("a.frag", shader("r = 1.0;").as_bytes()),
        ("glisten.toml", b"[lint.ranges]\nk = [1, 0]\nn = \"unite\"\nx = [0, 1]\n"),
    ]);
    let (findings, exit) = folder.lint(&["a.frag"]);
    let lines: Vec<u64> =
        findings.iter().filter(|one| one["code"] == "E0015").filter_map(|one| one["line"].as_u64()).collect();
    assert_eq!((lines, exit), (vec![2, 3], 1));
}

#[test]
fn a_scene_shows_the_finding() {
    let folder = Folder::new(&[("a.frag", shader("r = acos(dot(N, L));").as_bytes())]);
    let output = folder.run(&["lint", "a.frag", "--witnesses", "shown"]);
    assert_eq!(code(&output), 0, "{}", out(&output));
    let output = folder.run(&["stability", "shown/a_frag_3_l0030.toml", "--format", "json"]);
    let found: Value = serde_json::from_str(&out(&output)).expect("it is JSON");
    assert_eq!((found["verdict"].as_str(), code(&output)), (Some("broken"), 1));
    assert!(found["non_finite"].as_u64() > Some(0), "{found}");
}

#[test]
fn a_scene_states_ranges() {
    let text = "#version 150\nin float x; uniform float k; out vec4 c;\nvoid main() { c = vec4(x / (k - 0.5)); }\n";
    let vertex = "#version 150\nin vec3 p; out float x;\nvoid main() { x = p.x; gl_Position = vec4(p, 1.0); }\n";
    let scene = |values: &[f64]| {
        let draw = |k: &f64| {
            format!(
                "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n[draw.attributes]\n\
                 p = {{ size = 3, values = [0, 0, 0, 1, 0, 0, 0, 1, 0] }}\n[draw.uniforms]\nk = {k:?}\n"
            )
        };
        format!("[framebuffer]\nwidth = 8\nheight = 8\n{}", values.iter().map(draw).collect::<String>())
    };
    let (wide, narrow) = (scene(&[0.0, 1.0]), scene(&[0.75, 1.0]));
    let folder = Folder::new(&[
        ("a.frag", text.as_bytes()),
        ("a.vert", vertex.as_bytes()),
        ("wide.toml", wide.as_bytes()),
        ("narrow.toml", narrow.as_bytes()),
    ]);
    let told = |arguments: &[&str]| {
        let (findings, _) = folder.lint(arguments);
        findings.iter().filter(|one| one["code"] == "L0074" && one["file"] == "a.frag").count()
    };
    assert_eq!(told(&["."]), 0, "nothing is stated");
    assert_eq!(told(&[".", "--scene", "wide.toml"]), 1, "`k` is from 0 to 1 there");
    assert_eq!(told(&[".", "--scene", "narrow.toml"]), 0);
    assert_eq!(code(&folder.run(&["lint", ".", "--scene", "none.toml"])), 2);
}

#[test]
fn configurations_name_inputs_too() {
    let text = shader("\n#ifdef SHINY\nr = pow(dot(N, L), k);\n#else\nr = acos(x * 0.0);\n#endif\n");
    let folder = Folder::new(&[("a.frag", text.as_bytes())]);
    let (findings, _) = folder.lint(&["a.frag", "--configurations"]);
    let notes: Vec<String> =
        findings.iter().filter(|one| one["code"] == "L0028").map(|one| one["notes"].to_string()).collect();
    assert_eq!(notes.len(), 1, "{findings:?}");
    assert!(notes[0].contains("the reference computes it so") && notes[0].contains("only with `SHINY=1`"), "{notes:?}");
}

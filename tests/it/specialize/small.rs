//! Small programs of what a partial evaluation may easily take for certain: their residuals draw the same bytes.

use super::{bits, difference, load};
use glisten::scene::Scene;
use glisten::source::SourceMap;
use glisten::specialize::specialize_scene;

/// A fragment shader after its `#version` and its interface, the values of uniforms, and a texture.
struct Small<'a> {
    version: u32,
    text: &'a str,
    uniforms: &'a str,
    textures: &'a str,
}

const fn small(text: &str) -> Small<'_> {
    Small { version: 150, text, uniforms: "", textures: "" }
}

/// The index is 0, 1 or 2 by the fragment.
const INDEX: &str = "int index() { return int(v.x > 0.0) + int(v.y > 0.0); }\n";

/// How the residual of such a program differs.
fn wrong(small: &Small<'_>) -> Option<String> {
    let (scene, sources) = scene_of(small);
    let specialized = specialize_scene(&scene, &sources, &[]);
    let fault = specialized.draws.iter().find_map(|draw| draw.fault.clone());
    fault.or_else(|| difference(&scene, &specialized))
}

/// The picture of such a program.
fn picture(small: &Small<'_>) -> Result<Vec<u64>, String> {
    bits(&scene_of(small).0)
}

fn scene_of(small: &Small<'_>) -> (Scene, SourceMap) {
    let vertex = "#version 150\nin vec2 p;\nout vec2 v;\nvoid main() { v = p; gl_Position = vec4(p, 0.0, 1.0); }\n";
    let Small { version, text, uniforms, textures } = small;
    let fragment = format!("#version {version}\nin vec2 v;\nout vec4 color;\n{INDEX}{text}\n");
    let scene = format!(
        "[framebuffer]\nwidth = 16\nheight = 16\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nprimitive = \"triangle_strip\"\n\
         [draw.attributes]\np = {{ size = 2, values = [-1, -1, 1, -1, -1, 1, 1, 1] }}\n[draw.uniforms]\n{uniforms}\n[draw.textures]\n{textures}\n"
    );
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in [("a.vert", vertex), ("a.frag", fragment.as_str()), ("a.toml", scene.as_str())] {
        std::fs::write(folder.path().join(name), text).expect("written");
    }
    load(&folder.path().join("a.toml")).unwrap_or_else(|| panic!("no scene of\n{text}"))
}

fn all_draw_the_same(list: &[Small<'_>]) {
    let wrong: Vec<String> = list.iter().filter_map(wrong).collect();
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), list.len(), wrong.join("\n"));
}

#[test]
fn an_open_index_may_mean_any_component_of_a_swizzle() {
    all_draw_the_same(&[
        small(
            "void main() { vec3 a = vec3(1, 2, 3); int i = min(index(), 1); color = vec4(a.zx[i], a.bgr[i], a.zyx.zyx[i], 1); }",
        ),
        small(
            "void main() { vec3 a = vec3(1, 2, 3); int i = min(index(), 1); a.zx[i] = 9.0; color = vec4(a.z > 5.0, a.x, a.y, 1); }",
        ),
        small(
            "void main() { mat3 m = mat3(1, 2, 3, 4, 5, 6, 7, 8, 9); int i = index();\n\
             m[i].zy[min(i, 1)] += 10.0; color = vec4(m[i].zx[min(i, 1)], m[i][i], m[2].z, m[0].y); }",
        ),
        small(
            "struct S { vec3 a; float b[3]; };\nvoid main() { S s[3]; int i = index();\n\
             for (int k = 0; k < 3; k++) { s[k].a = vec3(k, k + 10, k + 20); s[k].b = float[3](1.0, 2.0, 3.0); }\n\
             s[i].a.zy[min(i, 1)] = 99.0; s[1].b[i] += 5.0; color = vec4(s[0].a.z, s[1].b[0], s[2].a.y, s[i].b[i]); }",
        ),
        small(
            "void twice(inout float x) { x = x * 2.0 + 1.0; }\nvoid seven(out float x) { x = 7.0; }\n\
             void main() { vec4 a = vec4(1, 2, 3, 4); int i = index(); twice(a.wzy[i]); seven(a.xw[min(i, 1)]); a.yz[min(i, 1)]++; color = a; }",
        ),
        small(
            "vec3 g = vec3(1, 2, 3);\nfloat of(int i) { return g.zx[i]; }\nvoid change(int i) { g.zx[i] = 50.0; }\n\
             void main() { int i = min(index(), 1); color.x = of(i); change(i); color.y = of(1 - i); color.zw = g.zx; }",
        ),
        small(
            "void main() { ivec3 a = ivec3(1, 2, 3); bvec3 b = bvec3(true, false, true); int i = min(index(), 1);\n\
             a.zx[i] = 8; b.xz[i] = false; color = vec4(a.z, a.x, b.x, b.z); }",
        ),
        Small {
            version: 420,
            ..small(
                "void main() { vec3 a = vec3(1, 2, 3); int i = min(index(), 1); color = a.zx[i].xxxx; a.zy[i].x = 5.0; color.w = a.z; }",
            )
        },
        Small {
            uniforms: "w = [1, 2, 3]",
            ..small(
                "uniform vec3 w;\nvoid main() { int i = min(index(), 1); color = vec4(w.zx[i], w.bgr[i], vec4(w, 4.0).wz[i], 1); }",
            )
        },
    ]);
}

#[test]
fn a_condition_says_nothing_of_what_it_changes() {
    const UP: &str =
        "bool up(inout float x) { x += 5.0; return true; }\nbool up(inout int x) { x += 3; return true; }\n";
    let list = [
        "float x = fract(v.x); if (x < 1.0 && up(x)) color.x = x > 4.0 ? 1.0 : 0.5;",
        "float x = fract(v.x); if (!(x >= 1.0 || !up(x))) color.x = x > 4.0 ? 1.0 : 0.5;",
        "int j = int(fract(v.x)); while (j < 2 && up(j)) color.x += j > 2 ? 1.0 : 0.5;",
        "for (int k = 0; k < 5 && (k += 2) > 0; k++) color.x += k > 5 ? 1.0 : 0.5;",
        "int q = int(v.x * 4.0); color.x = (q < 3 && up(q)) ? (q >= 3 ? 1.0 : 0.5) : (q >= 3 ? 0.25 : 0.125);",
        "int q = int(v.x * 4.0); if (q < 2 && up(q)) color.x = q >= 2 ? 1.0 : 0.5; else if (q >= 4 || up(q)) color.y = q < 2 ? 1.0 : 0.5;",
        "float y = fract(v.y); if (y < 0.5 && (y = 7.0) > 1.0) color.x = y > 2.0 ? 1.0 : 0.5;",
        "float y = fract(v.y); if (y < (y = 7.0)) color.x = y > 5.0 ? 1.0 : 0.5;",
        "int z = int(v.x * 8.0); if (z < 5 && ++z < 9) color.x = z >= 5 ? 1.0 : 0.5;",
        "float x = fract(v.x), most = 1.0; if (x < most && up(most)) color = vec4(most > 5.0, x < most, 0.0, 1.0);",
    ];
    let texts = list.map(|body| format!("{UP}void main() {{ color = vec4(0.0); {body} }}"));
    let wrong: Vec<String> = texts.iter().filter_map(|text| wrong(&small(text))).collect();
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), list.len(), wrong.join("\n"));
}

#[test]
fn a_part_is_chosen_before_its_value_is_computed() {
    const UP: &str =
        "int up(inout int k) { return k++; }\nvoid change(inout int k, inout float x) { k = 2; x += 10.0; }\n";
    let list = [
        "if (v.x > 0.0) a[k] += float(k++);",
        "if (v.x > 0.0) a[k] = float(up(k)) + 5.0;",
        "if (v.x > 0.0) a.zyx[k] *= float(k = 2) + 5.0;",
        "if (v.x > 0.0) change(k, a[k]);",
        "for (int i = 0; i < index(); i++) a[k % 3] -= float(k += 2);",
    ];
    let texts = list.map(|body| {
        format!("{UP}void main() {{ vec3 a = vec3(1, 2, 3); int k = int(v.y < 9.0); {body} color = vec4(a, k); }}")
    });
    // With the index known, and with the index open.
    let known = texts.clone().map(|text| text.replace("int(v.y < 9.0)", "1"));
    let pictures = |text: &String| picture(&small(text));
    for (open, known) in texts.iter().zip(&known) {
        assert_eq!(pictures(open), pictures(known), "{known}");
        assert_eq!(wrong(&small(open)).or_else(|| wrong(&small(known))), None);
    }
}

/// What was stored before is what a `return` gives.
#[test]
fn a_round_or_a_case_may_leave_the_function() {
    all_draw_the_same(&[
        small(
            "void main() { color = vec4(0.25); for (int i = 0; i < 3; i++) { if (v.x > float(i) * 0.5) return; } color = vec4(v, 1.0, 1.0); }",
        ),
        small(
            "void main() { color = vec4(0.25); int i = 0; do { if (i > index()) return; color.x = 0.5; color = vec4(0.75 * v.x); i++; } while (i < 4); color = vec4(1.0); }",
        ),
        small(
            "void main() { color = vec4(0.25); switch (index()) { case 1: return; case 2: color = vec4(0.5); return; } color = vec4(v, 1.0, 1.0); }",
        ),
        small(
            "void f(out vec4 a) { a = vec4(0.25); while (v.y > 0.0) { if (v.x > 0.0) return; a = vec4(0.5); break; } a = vec4(v, 1.0, 1.0); }\n\
             void main() { f(color); }",
        ),
    ]);
}

#[test]
fn a_switch_whose_last_case_does_nothing_is_still_one() {
    all_draw_the_same(&[small(
        "void main() { float x = 0.0; color = vec4(0.0); switch (index()) { case 0: color.x = 1.0; break; case 1: default: x = v.x; } }",
    )]);
}

#[test]
fn limits_of_functions_are_no_tighter_than_what_they_compute() {
    all_draw_the_same(&[
        Small {
            uniforms: "s = 1e-20",
            ..small(
                "uniform float s;\nvoid main() { float x = clamp(v.x * 2.0, 0.0, 1.0) * s; color = vec4(log2(x) > -66.47, log(x) > -46.06, log2(x) > -66.4, 1); }",
            )
        },
        Small {
            uniforms: "a = 1e30\nb = 1e-30",
            ..small(
                "uniform float a, b;\nvoid main() { float m = mod(clamp(v.x, -1.0, 1.0) * a, b); color = vec4(m < 1.0, isnan(m), m >= -1.0, 1); }",
            )
        },
        Small {
            uniforms: "a = 1e12",
            ..small(
                "uniform float a;\nvoid main() { float y = float(v.x * a); color = vec4(float(y) > 5e9, vec2(y).x > 5e9, y < -5e9, 1); }",
            )
        },
    ]);
}

#[test]
fn a_filter_may_lose_the_sign_of_a_zero() {
    let text = "uniform sampler2D t;\nvoid main() { color = vec4(1.0 / texture(t, v).w < 0.0, texture(t, v).w, texelFetch(t, ivec2(0), 0).w, 1); }";
    for filter in ["linear", "nearest"] {
        let values = "width = 2, height = 1, values = [1, 1, 1, -0.0, 1, 1, 1, -0.0]";
        let textures = format!("t = {{ {values}, filter = \"{filter}\" }}");
        all_draw_the_same(&[Small { textures: &textures, ..small(text) }]);
    }
}

//! Pictures in which a rounding decides at a border, as programs of others draw them: texels at and beyond the border of a
//! texture, directions at the edges of a cube, varyings that are the same at all vertices, varyings of points. No driver
//! is wrong there, and no verdict says so. These tests need a Vulkan software adapter.

use crate::cli::{Folder, code, err, out};
use serde_json::Value;

/// The varyings go through a division by w, which is not a power of two.
const VERTEX: &str = "#version 150\nin vec2 p;\nout vec2 q;\nout float same;\nvoid main() {\n    q = p * 0.5 + 0.5;\n    \
    same = 3.0;\n    gl_PointSize = 9.0;\n    float w = 1.1 + 0.3 * p.x;\n    gl_Position = vec4(p * w, 0.0, w);\n}\n";
const TRIANGLES: &str =
    "primitive = \"triangle_strip\"\n[draw.attributes]\np = { size = 2, values = [-1, -1, 1, -1, -1, 1, 1, 1] }\n";

/// A scene of 64 by 64 pixels.
fn folder(draw: &str, vertex: &str, fragment: &str) -> Folder {
    let scene =
        format!("[framebuffer]\nwidth = 64\nheight = 64\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n{draw}");
    let fragment = format!("#version 150\nin vec2 q;\nin float same;\nout vec4 c;\n{fragment}");
    Folder::new(&[("a.vert", vertex.as_bytes()), ("a.frag", fragment.as_bytes()), ("a.toml", scene.as_bytes())])
}

#[track_caller]
fn verify(folder: &Folder) -> (i32, Value) {
    let output = folder.run(&["verify", "a.toml", "--format", "json"]);
    (code(&output), serde_json::from_str(&out(&output)).unwrap_or_else(|error| panic!("{error}: {}", err(&output))))
}

/// Numbers between 0 and 1 that jump from one to the next.
fn values(count: usize) -> String {
    let each: Vec<String> = (0..count).map(|k| format!("{:.3}", (k * 7919 % 1000) as f64 / 1000.0)).collect();
    each.join(", ")
}

#[test]
fn a_varying_of_a_point_may_be_divided_by_w_and_multiplied_again() {
    let points = "primitive = \"points\"\nprogram_point_size = true\n[draw.attributes]\n\
                  p = { size = 2, values = [-0.7, -0.6, -0.31, 0.43, 0.2, -0.17, 0.47, 0.59, 0.83, -0.41] }\n";
    let (exit, json) = verify(&folder(points, VERTEX, "void main() { c = vec4(q, gl_PointCoord.x, q.x * same); }\n"));
    assert_eq!((exit, &json["verdict"], &json["outside"]), (0, &"holds".into(), &0.into()), "{json}");
    let (exit, json) = verify(&folder(points, VERTEX, "void main() { c = vec4(1.01 * q, gl_PointCoord); }\n"));
    assert_eq!((exit, &json["verdict"]), (0, &"holds".into()), "{json}");
    // With w = 1 there is nothing to divide by, so the number is exact.
    let plain = VERTEX.replace("1.1 + 0.3 * p.x", "1.0");
    let fragment = "void main() { c = vec4(same == 3.0 ? 1.0 : 0.0, q, 1.0); }\n";
    let (exit, json) = verify(&folder(points, &plain, fragment));
    let evidence = &json["evidence"];
    assert_eq!((exit, &evidence["judged"]), (0, &json["covered"]), "{json}");
}

/// Every pixel's center is on the border of two texels, each with a direction to another face.
#[test]
fn a_direction_that_jumps_hits_every_face_that_it_may() {
    let fragment = "uniform sampler2D normals;\nuniform samplerCube sky;\nvoid main() {\n    \
                    vec3 n = texture(normals, q).xyz * 2.0 - 1.0;\n    c = texture(sky, n);\n}\n";
    for filter in ["nearest", "linear"] {
        let textures = format!(
            "{TRIANGLES}[draw.textures]\nnormals = {{ width = 128, height = 1, values = [{}] }}\n\
             sky = {{ width = 4, height = 4, filter = \"{filter}\", values = [{}] }}\n",
            values(512),
            values(6 * 16 * 4)
        );
        // With the same w at all vertices, the coordinate is linear in the window.
        let even = VERTEX.replace(" + 0.3 * p.x", "");
        let (_, json) = verify(&folder(&textures, &even, fragment));
        assert_eq!((&json["outside"], &json["verdict"]), (&0.into(), &"inconclusive".into()), "{filter}: {json}");
        // A fault is still seen where the direction is certain.
        let smooth = textures.replace("height = 1, values", "height = 1, filter = \"linear\", values");
        let (_, json) = verify(&folder(&smooth, VERTEX, &fragment.replace("q)", "vec2(0.3, 0.5))")));
        assert_eq!((&json["outside"], &json["verdict"]), (&0.into(), &"holds".into()), "{filter}: {json}");
    }
}

/// A GPU that interpolates quotients by w is an ULP off, so a texel is decided by rounding.
#[test]
fn a_varying_that_is_the_same_at_all_vertices_is_a_rounding_off() {
    let texture = format!("{TRIANGLES}[draw.textures]\nt = {{ width = 4, height = 1, values = [{}] }}\n", values(16));
    let head = "uniform sampler2D t;\n";
    for line in ["c = textureLod(t, vec2(same / 3.0, 0.5), 0.0);", "c = vec4(float(int(same)) / 3.0, q, 1.0);"] {
        let (_, json) = verify(&folder(&texture, VERTEX, &format!("{head}void main() {{ {line} }}\n")));
        assert_ne!(json["verdict"], "fails", "{line}: {json}");
        assert_eq!(json["outside"], 0, "{line}: {json}");
    }
}

#[test]
fn a_fetch_beyond_the_border_is_undefined_and_a_fetch_at_the_border_is_not() {
    let texture = format!("{TRIANGLES}[draw.textures]\nt = {{ width = 8, height = 8, values = [{}] }}\n", values(256));
    let head = "uniform sampler2D t;\nvoid main() {\n    ivec2 at = ivec2(gl_FragCoord.xy) / 8;\n    ";
    for (line, undefined) in [
        ("c = texelFetch(t, at, 0);", 0),
        ("c = texelFetch(t, at + ivec2(1, 0), 0);", 8 * 64),
        ("c = texelFetchOffset(t, at, 0, ivec2(-1, -1));", 64 * 64 - 56 * 56),
        ("c = texelFetchOffset(t, at, 0, ivec2(2, 2));", 64 * 64 - 48 * 48),
        // A texel that does not count.
        ("c = mix(texelFetch(t, at, 0), texelFetch(t, clamp(at + 1, 0, 7), 0), 0.5);", 0),
        ("c = texelFetch(t, at, at.x < 4 ? 0 : 1);", 32 * 64),
    ] {
        let (_, json) = verify(&folder(&texture, VERTEX, &format!("{head}{line}\n}}\n")));
        assert_eq!(
            (&json["evidence"]["undefined"], &json["outside"]),
            (&undefined.into(), &0.into()),
            "{line}: {json}"
        );
        assert_eq!(json["verdict"], if undefined > 205 { "inconclusive" } else { "holds" }, "{line}: {json}");
        if undefined > 0 {
            assert!(json["undefined"].to_string().contains("texelFetch"), "{line}: {json}");
        }
    }
}

/// A multisample texture has as many samples as the scene gives it: another sample is undefined (GLSL 1.50 §8.7).
#[test]
fn a_sample_that_a_texture_does_not_have_is_undefined() {
    let head = "uniform sampler2DMS t;\nvoid main() {\n    ivec2 at = ivec2(gl_FragCoord.xy) / 16;\n    c = vec4(0.0);\n    \
                for (int i = 0; i < 4; ++i) c += texelFetch(t, at, i) * 0.25;\n}\n";
    for (samples, undefined) in [(4, 0), (1, 64 * 64)] {
        let texture = format!(
            "{TRIANGLES}[draw.textures]\nt = {{ width = 4, height = 4, values = [{}] }}\n",
            values(64 * samples)
        );
        let (_, json) = verify(&folder(&texture, VERTEX, head));
        assert_eq!((&json["evidence"]["undefined"], &json["outside"]), (&undefined.into(), &0.into()), "{json}");
    }
    // Without a texture, all of the default one's samples are (0, 0, 0, 1).
    let (_, json) = verify(&folder(TRIANGLES, VERTEX, &head.replace("ivec2(gl_FragCoord.xy) / 16", "ivec2(0)")));
    assert_eq!((&json["evidence"]["undefined"], &json["verdict"]), (&0.into(), &"holds".into()), "{json}");
}

//! Strings of all hosts: which are shaders, what their texts are, what is said about them.

use super::{Filling, Host, programs, styled};
use glisten_front::Stage;

/// The stages of the programs of a text, with the words of each shader.
fn found(host: Host, text: &str) -> Vec<Vec<(Stage, String)>> {
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let of = |program: super::Program| {
        let shaders = program.shaders.iter();
        shaders.map(|shader| (shader.stage, words(&shader.text(text, Filling::Name)))).collect()
    };
    programs(host, text).into_iter().map(of).collect()
}

const V: &str = "attribute vec4 p; void main() { gl_Position = p; }";
const F: &str = "void main() { gl_FragColor = vec4(1.0); }";

#[test]
fn pairs_are_found_in_every_host() {
    let pair = vec![vec![(Stage::Vertex, V.to_owned()), (Stage::Fragment, F.to_owned())]];
    for (host, text) in [
        (Host::Script, format!("const m = new M({{ vertexShader: `{V}`, fragmentShader: /* glsl */ `{F}` }});")),
        (Host::Script, format!("const waterVert = glsl`{V}`;\nexport const waterFrag = glsl`{F}`;")),
        (
            Host::Script,
            format!("let a = /`/; let b = x / y; // `\nlet s = \"`\"; const vs: string = `{V}`, fs = `{F}`;"),
        ),
        (
            Host::Rust,
            format!(
                "const VERT: &str = r#\"{V}\"#; fn f<'a>(c: char) {{ c == '\"' }} /* /* */ \" */\nconst FRAG: &str = r##\"{F}\"##;"
            ),
        ),
        (
            Host::Python,
            format!("prog = ctx.program(\n vertex_shader='''{V}''', # '''\n fragment_shader=\"\"\"{F}\"\"\")"),
        ),
        (
            Host::C,
            format!(
                "int n = 1'000; static const char* vertexSource = R\"glsl({V})glsl\";\nauto fragmentSource = R\"({F})\";"
            ),
        ),
        (
            Host::C,
            format!(
                "#include <a.h>\nstatic const char *vertex_src =\n    \"attribute vec4 p; \" /* \"glsl\" */\n    \"{}\";\nconst char* fragment_src = \"{F}\\n\";",
                &V["attribute vec4 p; ".len()..]
            ),
        ),
    ] {
        assert_eq!(found(host, &text), pair, "{text}");
    }
}

#[test]
fn other_strings_are_left_alone() {
    for (host, text) in [
        (
            Host::C,
            "auto s = \"void main() {\\n\" \"  vec4 Kd = \"+str(color)+\";\\n\" \"  gl_FragColor = Kd;\\n}\";"
                .to_owned(),
        ),
        (Host::C, "out << \"void main() { gl_FragColor = vec4(\" << gray << \"); }\";".to_owned()),
        (
            Host::C,
            "#define GEO(shader) \"#version 120\\n#extension GL_EXT_geometry_shader4: enable\\n\" #shader\n\
             #define G410(shader)  \"#version 410 \\n #define TINY 0.000001 \\n\" #shader\n"
                .to_owned(),
        ),
        (Host::Script, "const a = html`<p>void main() { vec4 }</p>`; const b = `#version of the file`;".to_owned()),
        (
            Host::Script,
            "const a = `@fragment fn main() -> @location(0) vec4f { return vec4f(1.0); }`; void 0;".to_owned(),
        ),
        (Host::Script, format!("const a = `{F}")),
        (Host::Rust, "let a = r#\"void main() { printf(\"glsl\"); }\"#;".to_owned()),
        (Host::C, "const char* a = R\"(#version 430\nlayout(local_size_x = 1) in; void main() {})\";".to_owned()),
        (Host::C, format!("f(\"#version %d\\n{F}\", 3); const char* s = HEADER \"{F}\"; const char* t = \"{F}\" END;")),
        (Host::C, "const char* s = \"void main() { vec4 a; }".to_owned()),
        (
            Host::C,
            format!("const char* s =\n#if A\n\"#version 330\\n\"\n#else\n\"#version 150\\n\"\n# endif\n\"{F}\";\n"),
        ),
        (Host::Python, "a = '''void main''' # glsl".to_owned()),
        (Host::Python, format!("EXAMPLE = '''\nvertex = \"\"\"\n{V}\n\"\"\"\nx = vertex\n'''")),
        (Host::Rust, format!("const HELP: &str = r#\"It is\n```glsl\n{F}\n```\nand more\"#;")),
        (Host::Python, format!("def f():\n    '''{F}'''\n")),
        (Host::Script, format!("const a = `{F}`.replace(/A/g, b);")),
    ] {
        assert_eq!(found(host, &text), Vec::<Vec<(Stage, String)>>::new(), "{text}");
    }
}

#[test]
fn the_last_word_of_a_name_tells_the_stage() {
    let main = "#version 330\nout vec4 c; void main() { c = vec4(1.0); }";
    for (name, stage) in [
        ("GEOMETRY_PASS_FS", Stage::Fragment),
        ("GEOMETRY_OUTPUT_FRAGMENT_SHADER", Stage::Fragment),
        ("geometryFragmentSource", Stage::Fragment),
        ("FS_GEOMETRY", Stage::Geometry),
    ] {
        let found = found(Host::C, &format!("const char* {name} = R\"({main})\";"));
        assert_eq!(found.first().and_then(|program| program.first()).map(|(stage, _)| *stage), Some(stage), "{name}");
    }
    let text = format!("#define A \"{F}\"\n#define B 1\n#ifdef C\n#define D \"{V}\"\n#endif\n");
    assert_eq!(found(Host::C, &text).into_iter().flatten().count(), 2);
}

#[test]
fn bytes_stay_at_their_places() {
    let text = "// é𝄞\nconst f = `#version 300 es\\n// \\`é\\` \\u{41}\r\nout vec4 c; void main() { c = vec4(${ `}` + \"}\" }, 1., 1., 1.); }\n${\nrest\n}\n`; // void";
    let programs = programs(Host::Script, text);
    let shader = &programs[0].shaders[0];
    let masked = shader.text(text, Filling::Name);
    assert_eq!(masked.len(), text.len());
    for word in ["#version", "vec4(", "main", "é\\` "] {
        let place = text[shader.inside.start..].find(word).map(|at| at + shader.inside.start);
        let word = word.trim_end_matches("\\` ");
        assert!(place.is_some_and(|at| masked[at..].starts_with(word)), "{word}: {masked:?}");
    }
    assert!(masked.contains("300 es \n//  `é `      A\r\n") && masked.contains("vec4(hoo"), "{masked:?}");
    assert!(!masked.contains("rest") && !masked.contains('$'), "{masked:?}");
    let whole = shader.text(text, Filling::Whole);
    assert!(whole.contains("vec4(1 "), "{whole:?}");
}

#[test]
fn strings_of_c_that_follow_each_other_are_one() {
    let text = "const char* vs =\n    \"#version 330\\n\"\n    \"#define N \"\n    \"2\\n\" // two\n    \"// it's \\\"N\\\"\\n\"\n    \"void main() { gl_Position = vec4(N); }\\n\";\n";
    let programs = programs(Host::C, text);
    let shader = &programs[0].shaders[0];
    let masked = shader.text(text, Filling::Name);
    assert_eq!(masked.len(), text.len());
    let lines: Vec<String> = masked.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    let lines: Vec<&str> = lines.iter().map(String::as_str).filter(|line| !line.is_empty()).collect();
    assert_eq!(
        lines,
        ["#version 330", "#define N 2", "// it's \"N \"", "void main() { gl_Position = vec4(N); }"],
        "{masked:?}"
    );
    assert_eq!(masked.find("void main"), text.find("void main"));
}

#[test]
fn lines_that_a_host_joins_are_one_line() {
    for (host, text) in [
        (Host::Python, "FRAG = '''\\\n#version 150 // a \\\r\nx\nvoid main() { gl_FragColor = vec4(1.0); }'''\n"),
        (Host::Script, "const FRAG = `\\\n#version 150 // a \\\r\nx\nvoid main() { gl_FragColor = vec4(1.0); }`;\n"),
        (
            Host::C,
            "const char* frag = \"\\\n#version 150 // a \\\r\nx\\n\\\nvoid main() { gl_FragColor = vec4(1.0); }\";\n",
        ),
    ] {
        let programs = programs(host, text);
        let masked = programs[0].shaders[0].text(text, Filling::Name);
        assert_eq!(masked.len(), text.len());
        let lines: Vec<String> =
            masked.trim().lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
        assert_eq!(lines, ["#version 150 // a x", "void main() { gl_FragColor = vec4(1.0); }"], "{text}");
    }
}

#[test]
fn numbers_of_characters_are_read() {
    let text = "const char* f = \"void main() { gl_FragColor = vec4(1.0)\\x3b \\175\\0\";";
    let expected = vec![vec![(Stage::Fragment, "void main() { gl_FragColor = vec4(1.0) ; }".to_owned())]];
    assert_eq!(found(Host::C, text), expected);
}

#[test]
fn conversions_of_python_are_interpolations() {
    let main = "void main() { gl_FragColor = vec4(";
    let of = |text: &str| found(Host::Python, text).into_iter().flatten().map(|(_, text)| text).collect::<Vec<_>>();
    for (text, expected) in [
        (format!("f = '''{main}1 %% 2, %d, %.2f, 1); }}''' % (a, b)"), format!("{main}1 % 2, ho, hooo, 1); }}")),
        (format!("f = '''{main}a %(alpha)s, 1); }}'''"), format!("{main}a hoooooooo, 1); }}")),
        (format!("f = '''{main}%s, a %d); }}'''\ng = f % 1"), format!("{main}ho, a ho); }}")),
        (format!("f = '''{main}a %d, b % c); /* %s */ }}'''"), format!("{main}a %d, b % c); /* %s */ }}")),
    ] {
        assert_eq!(of(&text), [expected], "{text}");
    }
}

#[test]
fn styles_keep_what_is_not_theirs() {
    let text = "const f = /* glsl */ `\n    #define N ${n}\n    // \\`x\\`\n    void main(){float a=${b};\n    gl_FragColor=vec4(a); }\n    ${rest}\n  `;\nconst g = `${f}void main(){gl_FragColor=vec4(1);}`;\n";
    let mut upper = |text: &str| text.replace("float a=", "float a = ").replace("{float", "{\n    float");
    let programs = programs(Host::Script, text);
    let once = styled(text, &programs, &mut upper);
    let expected = text.replace("float a=${b}", "float a = ${b}").replace("{float", "{\n        float");
    assert_eq!(once, expected);
}

#[test]
fn hostile_texts_end() {
    for piece in [
        "`",
        "${",
        "r#\"",
        "R\"(",
        "'''",
        "/*",
        "\\",
        "{",
        "é",
        "`${`",
        "f'''{",
        "format!(\"",
        "\"",
        "\"glsl\\",
        "\" \"",
    ] {
        for host in [Host::Script, Host::Rust, Host::Python, Host::C] {
            let text = format!("glsl void #version {}", piece.repeat(3000));
            for program in programs(host, &text) {
                for shader in &program.shaders {
                    assert_eq!(shader.text(&text, Filling::Type).len(), text.len(), "{piece}");
                }
                styled(&text, &[program], &mut str::to_owned);
            }
        }
    }
}

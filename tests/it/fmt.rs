//! `glisten fmt`, end to end: what changes, what is kept, and that a second run changes nothing.

use crate::cli::{Folder, code, err, out};
use std::fs;
use std::path::{Path, PathBuf};

#[test]
fn files_are_rewritten_once() {
    let folder = Folder::new(&[
        ("a.frag", b"#version 150\nout vec4 c;void main(){c=vec4(1.0);}\n"),
        ("sub/inc.glsl", b"float f( float x ){\nreturn x;}\n"),
        ("sub/glisten.toml", b"[fmt]\nindent = \"tab\"\nbraces = \"next-line\"\n"),
        ("notes.txt", b"a  b\n"),
        (".gitignore", b"made/\n"),
        ("made/b.frag", b"void main(){}"),
    ]);
    let check = folder.run(&["fmt", "--check"]);
    assert_eq!((code(&check), out(&check)), (1, "would reformat a.frag\nwould reformat sub/inc.glsl\n".into()));
    let diff = folder.run(&["fmt", "--diff", "a.frag"]);
    assert_eq!(code(&diff), 0);
    assert!(out(&diff).contains("-out vec4 c;void main(){c=vec4(1.0);}\n+out vec4 c;\n"), "{}", out(&diff));
    assert!(err(&folder.run(&["fmt"])).contains("2 of 2 files changed"));
    let text = |name: &str| fs::read_to_string(folder.path(name)).expect(name);
    assert_eq!(text("a.frag"), "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n");
    assert_eq!(text("sub/inc.glsl"), "float f(float x)\n{\n\treturn x;\n}\n");
    assert_eq!((text("notes.txt"), text("made/b.frag")), ("a  b\n".into(), "void main(){}".into()));
    let again = folder.run(&["fmt", "--check"]);
    assert_eq!((code(&again), out(&again)), (0, String::new()));
}

#[test]
fn files_that_are_no_text_are_left_alone() {
    let files: [(&str, &[u8]); 4] = [
        ("spirv.vert", b"\x03\x02\x23\x07\0\0\x01\0"),
        ("wide.frag", b"\xff\xfev\0o\0i\0d\0"),
        ("empty.frag", b" \n"),
        ("empty.glsl", b""),
    ];
    let folder = Folder::new(&files);
    for arguments in [&["fmt"][..], &["fmt", "--check"], &["fmt", "spirv.vert", "wide.frag", "empty.frag"]] {
        let run = folder.run(arguments);
        let told = err(&run);
        assert!(code(&run) == 1 && out(&run).is_empty(), "{told}");
        assert_eq!((told.matches("error[E0014]").count(), told.matches("error[E0013]").count()), (2, 1), "{told}");
    }
    for (name, bytes) in files {
        assert_eq!(fs::read(folder.path(name)).expect(name), bytes, "{name}");
    }
}

#[test]
fn what_cannot_be_laid_out_is_kept() {
    let folder = Folder::new(&[
        ("a.frag", b"#version 150\nfloat   x = ;\nout vec4   c;\nvoid main(){c=vec4(1.0);}\n"),
        // Shift_JIS in a comment.
        ("b.frag", b"//  \x95\x5c\x8e\xa6 a\nfloat   x;\r\n"),
    ]);
    let run = folder.run(&["fmt"]);
    assert!(err(&run).contains("kept"), "{}", err(&run));
    let bytes = |name: &str| fs::read(folder.path(name)).expect(name);
    assert_eq!(bytes("a.frag"), b"#version 150\nfloat   x = ;\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n");
    assert_eq!(bytes("b.frag"), b"//  \x95\x5c\x8e\xa6 a\nfloat x;\n");
}

/// The places that do not parse depend on the lines, which formatting changes.
#[test]
fn a_wrong_text_is_formatted_once_too() {
    let folder = Folder::new(&[]);
    for text in [
        "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }out\n\n; block\n{\n\tvec4 d;\n} Out;\n",
        "#version 150\nin vec4 a;\nin\n; vec4 b;\nvoid main() { }\n",
        "#version 150\nvoid\n\n; main()\n{ gl_Position = vec4(1.0); }\n",
        "#version 150\nout vec4 c;\nvoid main() { if (true) { vec4\n; c = vec4(1.0); }\n",
        "#version 150\nuniform { float a; };\nuniform\n;\nvoid main() { switch (1) { case case 1: break; } }\n",
    ] {
        let run = |text: &str| out(&folder.run_with_input(&["fmt", "--stdin-filename", "a.vert", "-"], text));
        let once = run(text);
        assert_eq!(run(&once), once, "{text}");
    }
}

#[test]
fn standard_input_and_mistakes() {
    let folder = Folder::new(&[
        ("glisten.toml", b"[fmt]\nindent = 2\n"),
        ("bad/glisten.toml", b"[fmt]\nbraces = \"next-lin\"\nwidth = 10\n"),
        ("bad/a.frag", b"float   x;\n"),
    ]);
    let run = folder.run_with_input(&["fmt", "--stdin-filename", "a.frag", "-"], "void main(){x;y;}");
    assert_eq!((code(&run), out(&run)), (0, "void main() {\n  x;\n  y;\n}\n".into()));
    let bad = folder.run(&["fmt", "bad"]);
    assert_eq!(code(&bad), 1);
    for part in ["did you mean `next-line`?", "`width` must be 40 to 400"] {
        assert!(err(&bad).contains(part), "{part}: {}", err(&bad));
    }
    assert_eq!(fs::read(folder.path("bad/a.frag")).expect("a file"), b"float   x;\n");
    assert_eq!(code(&folder.run(&["fmt", "nowhere.frag"])), 2);
}

/// Blanks matter in other files: only what is named as a shader, begins as one or parses is formatted.
#[test]
fn files_of_other_kinds_are_refused() {
    let others: [(&str, &str); 7] = [
        ("Makefile", "all:\n\tcc   -c a.c\n"),
        ("a.yml", "a:\n    - b:   1\n"),
        ("a.md", "# Title\n\n    void main() {}\n\n```glsl\n#version 150\nvoid  main(){}\n```\n"),
        ("a.mtl", "newmtl   x\nKd 1 1 1\n"),
        ("a.obj", "v  0 0 0\nf   1 2 3\n"),
        ("a.csv", "a,b,  c\n1,2,  3\n"),
        ("a.json", "{\"a\":   [1]}\n"),
    ];
    let files: Vec<(&str, &[u8])> = others.iter().map(|(name, text)| (*name, text.as_bytes())).collect();
    let folder = Folder::new(&files);
    for (name, text) in others {
        let run = folder.run(&["fmt", name]);
        assert_eq!(code(&run), 2, "{name}");
        assert!(err(&run).contains("is no shader by its name"), "{name}: {}", err(&run));
        assert_eq!(fs::read_to_string(folder.path(name)).expect("a file"), text, "{name}");
        assert_eq!(code(&folder.run_with_input(&["fmt", "--stdin-filename", name, "-"], text)), 2, "{name}");
    }
    let shaders = [
        ("a.inc", "float   f(float x){return x;}\n"),
        ("shader.txt", "// a shader\n#version 150\nvoid  main(){}\n"),
        ("a.gdshader", "shader_type   canvas_item;\n"),
    ];
    for (name, text) in shaders {
        let run = folder.run_with_input(&["fmt", "--stdin-filename", name, "-"], text);
        assert!(code(&run) == 0 && out(&run) != text, "{name}: {}", err(&run));
    }
}

/// All GLSL of the repository, valid or not; some files are none, and are there to be refused.
fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        let extension = entry.extension().and_then(|extension| extension.to_str()).unwrap_or("");
        if entry.is_dir() {
            sources(&entry, into);
        } else if ["vert", "frag", "geom", "glsl", "fsh", "vsh", "fs", "vs"].contains(&extension) {
            let bytes = fs::read(&entry).expect("a file");
            if !bytes.contains(&0) && !bytes.iter().all(u8::is_ascii_whitespace) {
                into.push(entry);
            }
        }
    }
}

#[test]
fn sources_of_the_repository_keep_their_tokens() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    sources(&root.join("fixtures"), &mut paths);
    sources(&root.join("shader_lib"), &mut paths);
    assert!(paths.len() > 600, "{} sources", paths.len());
    let folder = Folder::new(&[]);
    for (number, path) in paths.iter().enumerate() {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or("a.frag");
        let into = folder.path(&format!("{number}/{name}"));
        fs::create_dir_all(into.parent().expect("a folder")).expect("made");
        fs::copy(path, into).expect("copied");
    }
    assert_eq!(code(&folder.run(&["fmt"])), 0);
    let again = folder.run(&["fmt", "--check"]);
    assert_eq!((code(&again), out(&again)), (0, String::new()), "a second run changes nothing");
    // Without white space, nothing has changed. (Inside of comments and directives, white space stays, too; the unit tests say so.)
    let bare = |path: &Path| -> Vec<u8> {
        fs::read(path).expect("a file").into_iter().filter(|byte| !byte.is_ascii_whitespace()).collect()
    };
    for (number, path) in paths.iter().enumerate() {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or("a.frag");
        assert!(bare(path) == bare(&folder.path(&format!("{number}/{name}"))), "{}", path.display());
    }
}

#[test]
fn shaders_in_strings_are_formatted() {
    let script = "const a   = `\n    precision mediump float;\n    uniform vec3   tint;\n    void main(){gl_FragColor=vec4(tint*${ k },1.0);}\n`;\nfunction  f(){return   a}\n";
    let styled = "const a   = `\n    precision mediump float;\n    uniform vec3 tint;\n    void main() { gl_FragColor = vec4(tint * ${ k }, 1.0); }\n`;\nfunction  f(){return   a}\n";
    let folder = Folder::new(&[("app.js", script.as_bytes()), ("a.frag", b"float   x;\n"), ("b.py", b"x  =  1\n")]);
    let refused = folder.run(&["fmt", "app.js"]);
    assert_eq!(code(&refused), 2);
    assert!(err(&refused).contains("--embedded"), "{}", err(&refused));
    let check = folder.run(&["fmt", "--check"]);
    assert_eq!((code(&check), out(&check)), (1, "would reformat a.frag\n".into()), "strings are not looked at");
    let check = folder.run(&["fmt", "--embedded", "--check"]);
    assert_eq!((code(&check), out(&check)), (1, "would reformat a.frag\nwould reformat app.js\n".into()));
    assert_eq!(code(&folder.run(&["fmt", "--embedded"])), 0);
    assert_eq!(fs::read_to_string(folder.path("app.js")).expect("a file"), styled);
    assert_eq!(fs::read(folder.path("b.py")).expect("a file"), b"x  =  1\n");
    assert_eq!(code(&folder.run(&["fmt", "--embedded", "--check"])), 0, "a second run changes nothing");
    let piped = folder.run_with_input(&["fmt", "--embedded", "--stdin-filename", "app.js", "-"], script);
    assert_eq!((code(&piped), out(&piped)), (0, styled.to_owned()));
    assert_eq!(code(&folder.run_with_input(&["fmt", "--stdin-filename", "app.js", "-"], script)), 2);
}

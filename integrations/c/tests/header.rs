//! `glisten.h` is what cbindgen makes of the sources. `UPDATE_HEADER=1` writes it.

use std::fs;
use std::path::Path;

#[test]
fn the_header_is_current() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml")).expect("a configuration");
    let mut builder = cbindgen::Builder::new().with_config(config);
    // The order of the header.
    for file in ["status", "names", "blob", "diagnostic", "reply", "compiler", "program", "upgrade", "scene", "picture"]
    {
        builder = builder.with_src(folder.join(format!("src/{file}.rs")));
    }
    let mut bytes = Vec::new();
    builder.generate().expect("the sources are understood").write(&mut bytes);
    let text = String::from_utf8(bytes).expect("a text");
    // What a Rust reader wants to know of safety is said at the top of the header.
    let lines: Vec<&str> = text.lines().collect();
    let mut kept = String::new();
    let mut inside = false;
    for (index, line) in lines.iter().enumerate() {
        let next_is_safety = lines.get(index + 1).is_some_and(|next| next.trim() == "// # Safety");
        inside = (inside && line.starts_with("//")) || line.trim() == "// # Safety";
        let is_last_before = next_is_safety && line.trim() == "//";
        if !(inside || is_last_before) {
            kept.push_str(line);
            kept.push('\n');
        }
    }
    let path = folder.join("glisten.h");
    if std::env::var_os("UPDATE_HEADER").is_some() {
        fs::write(&path, &kept).expect("the header can be written");
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == kept, "glisten.h is not current: UPDATE_HEADER=1 cargo test -p glisten-c --test header");
}

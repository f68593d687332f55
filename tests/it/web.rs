//! The npm package, where it has been built: its own tests, which compare it with this program.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

#[test]
fn the_package_gives_what_the_program_gives() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let package = std::env::var_os("GLISTEN_WEB").map_or_else(|| root.join("target/web/package"), PathBuf::from);
    let runs_node = Command::new("node").arg("--version").output().is_ok_and(|node| node.status.success());
    if !package.join("reference.wasm").is_file() || !runs_node {
        let message = "\nthe npm package is not tried: `integrations/web/make` builds it; it needs Node";
        // The harness would keep what `eprintln` prints to itself.
        writeln!(std::io::stderr(), "{message}").expect("it can be told");
        return;
    }
    let tests =
        ["api", "native", "size", "vite"].map(|name| root.join(format!("integrations/web/test/{name}.test.mjs")));
    let ran = Command::new("node")
        .arg("--test")
        .args(tests)
        .env("GLISTEN", env!("CARGO_BIN_EXE_glisten"))
        .env("GLISTEN_WEB", &package)
        .output()
        .expect("node runs");
    assert!(ran.status.success(), "{}\n{}", String::from_utf8_lossy(&ran.stdout), String::from_utf8_lossy(&ran.stderr));
}

//! Nothing: without a build script, dependencies of build scripts are left out.
fn main() {
    println!("cargo:rerun-if-changed=build.rs");
}

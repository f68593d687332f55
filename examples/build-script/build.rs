//! Compiles `shaders/wave`, which includes a lighting model of the library, to a Rust module.
//!
//! An error in a shader stops the build with the same excerpt as in `glisten lint`.

fn main() {
    glisten::build::Build::new().folder("shaders").run();
}

//! Compiles the shaders of the example without a window, and writes their Rust module.

fn main() {
    glisten::build::Build::new().folder("../wgpu/shaders").bytemuck().glam().wgpu().without_spirv().run();
}

//! Compiles `shaders/lit` and writes its Rust module.

fn main() {
    glisten::build::Build::new().folder("shaders").bytemuck().glam().wgpu().without_spirv().run();
}

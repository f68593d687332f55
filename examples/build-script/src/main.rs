//! Shows the results of `build.rs`: WGSL for the pipeline, and the uniforms as a struct with the layout of the buffer.

/// The shaders, as `build.rs` wrote them.
mod shaders {
    include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
}

use shaders::glisten_memory::Bytes;
use shaders::wave;

fn main() {
    let mut uniforms = wave::Uniforms::new();
    uniforms.set_time(0.5).set_color([0.2, 0.4, 0.8, 1.0]);
    println!("{} bytes of uniforms: {:?}", wave::Uniforms::SIZE, uniforms);
    assert_eq!(uniforms.to_bytes().len() as u64, wave::Uniforms::SIZE);
    println!("{}\n{}", wave::VERTEX_WGSL, wave::FRAGMENT_WGSL);
}

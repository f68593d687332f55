//! Shows the results of `build.rs`: WGSL for the pipeline, and the offset of each uniform in the uniform buffer.

/// Byte offsets of the uniforms in their buffer.
mod offsets {
    include!(concat!(env!("OUT_DIR"), "/offsets.rs"));
}

const VERTEX: &str = include_str!(concat!(env!("OUT_DIR"), "/wave.vert.wgsl"));
const FRAGMENT: &str = include_str!(concat!(env!("OUT_DIR"), "/wave.frag.wgsl"));

fn main() {
    println!("`mc` at byte {}, `time` at byte {}, `color` at byte {}", offsets::MC, offsets::TIME, offsets::COLOR);
    println!("`light` at byte {}", offsets::LIGHT);
    println!("{VERTEX}\n{FRAGMENT}");
}

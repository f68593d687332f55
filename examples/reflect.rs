//! Reads the reflection of a program as a host would: vertex layout, uniform offsets, bindings.
//!
//! ```sh
//! cargo run --no-default-features --example reflect
//! ```

#![expect(clippy::print_stdout, reason = "an example prints")]

use glisten_emit::{Conventions, reflect};
use glisten_front::hir::Stage;
use glisten_front::{Compiler, Options, Source};

const VERTEX: &str = "#version 150 core
in vec4 pv;
in vec3 nv;
uniform mat4 mc;
uniform struct { vec3 direction; float intensity; } light[2];
out float brightness;
void main(void)
{
    brightness = 0.0;
    for (int i = 0; i < 2; ++i)
        brightness += light[i].intensity * max(dot(nv, light[i].direction), 0.0);
    gl_Position = mc * pv;
}
";

const FRAGMENT: &str = "#version 150 core
uniform sampler2D tex;
in float brightness;
out vec4 fc;
void main(void)
{
    fc = brightness * texture(tex, gl_FragCoord.xy / 512.0);
}
";

fn main() {
    let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
    let sources = [source("lit.vert", VERTEX, Stage::Vertex), source("lit.frag", FRAGMENT, Stage::Fragment)];
    // An OpenGL host did this with glBindAttribLocation before linking.
    let options = Options { attribute_locations: vec![("pv".to_owned(), 0)], ..Options::default() };
    let compilation = Compiler::new(options).compile(&sources);
    let program = compilation.program.expect("the shaders above have no errors");
    let reflection = reflect(&program, &Conventions::default());
    for attribute in &reflection.attributes {
        println!("attribute {} ({}) at location {}", attribute.name, attribute.ty, attribute.location);
    }
    for uniform in &reflection.uniforms {
        println!(
            "uniform {} ({}) in group {}, binding {}, at byte {}",
            uniform.name, uniform.ty, uniform.group, uniform.binding, uniform.offset
        );
    }
    for sampler in &reflection.samplers {
        println!(
            "sampler {}: texture at {}.{}, sampler at {}.{}",
            sampler.name,
            sampler.texture.group,
            sampler.texture.binding,
            sampler.sampler.group,
            sampler.sampler.binding
        );
    }
}

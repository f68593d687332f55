//! Descriptors and constructors for wgpu.
//!
//! *In:* the reflection, the uniform buffers, the vertices. *Out:* the text of vertex buffer layouts, bind group layouts, bind
//! groups with a field for each resource, and a pipeline. *Holds:* group 0 has the uniform buffers, group 1 the textures and
//! samplers, each with bindings from 0 on without gaps.

use super::layout::{Buffer, Layouts};
use super::names::{field, fresh};
use super::vertex::{Place, VertexStruct, Vertices};
use glisten_emit::Reflection;
use glisten_emit::reflection::Sampler;
use glisten_front::hir::Stage;
use std::fmt::Write;

/// A resource of a bind group.
struct Entry {
    binding: u32,
    visibility: String,
    name: String,
    doc: String,
    /// The type of the field.
    ty: &'static str,
    /// The binding type of the layout.
    layout: String,
    /// The resource of the field.
    resource: fn(&str) -> String,
}

/// Everything for wgpu.
pub(super) fn text(reflection: &Reflection, layouts: &Layouts, vertices: &Vertices) -> String {
    let groups = [buffers(reflection, layouts), textures(reflection)];
    let count = groups.iter().rposition(|group| !group.is_empty()).map_or(0, |last| last + 1);
    let mut text = String::new();
    for one in &vertices.structs {
        text.push_str(&vertex(one));
    }
    for (number, group) in groups.iter().enumerate().take(count) {
        text.push_str(&bind_group(number, group));
    }
    let has = |stage: &Option<String>| stage.is_some();
    for (stage, is_there) in [
        (Stage::Vertex, has(&reflection.entry_points.vertex)),
        (Stage::Fragment, has(&reflection.entry_points.fragment)),
    ] {
        if is_there {
            text.push_str(&shader_module(stage));
        }
    }
    text.push_str(&pipeline_layout(count));
    if has(&reflection.entry_points.vertex) && has(&reflection.entry_points.fragment) {
        text.push_str(&pipeline(reflection, vertices));
    }
    text
}

fn vertex(one: &VertexStruct) -> String {
    let VertexStruct { name, places, .. } = one;
    let step = if *name == "Vertex" { "Vertex" } else { "Instance" };
    let attributes: Vec<String> = places
        .iter()
        .map(|Place { location, offset, format }| {
            let format = variant(format);
            format!("wgpu::VertexAttribute {{ format: wgpu::VertexFormat::{format}, offset: {offset}, shader_location: {location} }}")
        })
        .collect();
    let mut text = format!("impl {name} {{\n/// The attributes of the buffer's layout.\n");
    let _ = writeln!(
        text,
        "pub const ATTRIBUTES: [wgpu::VertexAttribute; {}] = [{}];\n",
        attributes.len(),
        attributes.join(", ")
    );
    text.push_str(
        "/// The layout of a buffer of these.\npub const fn layout() -> wgpu::VertexBufferLayout<'static> {\n",
    );
    let _ = writeln!(
        text,
        "wgpu::VertexBufferLayout {{ array_stride: Self::STRIDE, step_mode: wgpu::VertexStepMode::{step}, attributes: &Self::ATTRIBUTES }}\n}}\n}}\n"
    );
    text
}

/// `Float32x3` for `float32x3`
fn variant(format: &str) -> String {
    let mut letters = format.chars();
    letters.next().map(|first| first.to_ascii_uppercase()).into_iter().chain(letters).collect()
}

fn visibility(stages: &[String]) -> String {
    let one = |stage: &String| format!("wgpu::ShaderStages::{}", stage.to_uppercase());
    match stages.iter().map(one).reduce(|all, one| format!("{all}.union({one})")) {
        Some(stages) => stages,
        None => "wgpu::ShaderStages::NONE".into(),
    }
}

/// The entries of group 0.
fn buffers(reflection: &Reflection, layouts: &Layouts) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    for Buffer { binding, ty, .. } in layouts.buffers.iter().filter(|buffer| buffer.group == 0) {
        let block = reflection
            .blocks
            .iter()
            .find(|block| (block.binding..block.binding + block.array_size.unwrap_or(1)).contains(binding));
        let stages = match block {
            Some(block) => visibility(&block.visibility),
            None => reflection.loose_block.as_ref().map_or_else(String::new, |loose| visibility(&loose.visibility)),
        };
        let wanted = block.map_or("uniforms", |block| &block.name);
        let name = fresh(field(wanted), |name| entries.iter().any(|known| known.name == name));
        entries.push(Entry {
            binding: *binding,
            visibility: stages,
            name,
            doc: format!("A buffer of [`{ty}`]."),
            ty: "&'a wgpu::Buffer",
            layout: format!(
                "wgpu::BindingType::Buffer {{ ty: wgpu::BufferBindingType::Uniform, has_dynamic_offset: false, \
                 min_binding_size: core::num::NonZeroU64::new({ty}::SIZE) }}"
            ),
            resource: |name| format!("resources.{name}.as_entire_binding()"),
        });
    }
    entries.sort_by_key(|entry| entry.binding);
    entries
}

/// The entries of group 1.
fn textures(reflection: &Reflection) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    for sampler in &reflection.samplers {
        let Sampler { view_dimension, sample_type, multisampled, .. } = sampler;
        let taken = |name: &str| entries.iter().any(|known| known.name == name);
        let name = fresh(field(&sampler.name), taken);
        let sample = match sample_type.as_str() {
            "float" => "Float { filterable: true }",
            "unfilterable-float" => "Float { filterable: false }",
            "depth" => "Depth",
            "sint" => "Sint",
            _ => "Uint",
        };
        let dimension = dimension(view_dimension);
        entries.push(Entry {
            binding: sampler.texture.binding,
            visibility: visibility(&sampler.visibility),
            name,
            doc: format!("The texture of `{}`, a `{}`.", sampler.name, sampler.ty),
            ty: "&'a wgpu::TextureView",
            layout: format!(
                "wgpu::BindingType::Texture {{ sample_type: wgpu::TextureSampleType::{sample}, view_dimension: \
                 wgpu::TextureViewDimension::{dimension}, multisampled: {multisampled} }}"
            ),
            resource: |name| format!("wgpu::BindingResource::TextureView(resources.{name})"),
        });
        let Some(kind) = &sampler.sampler_type else { continue };
        let kind = if kind == "comparison" { "Comparison" } else { "Filtering" };
        let taken = |name: &str| entries.iter().any(|known| known.name == name);
        entries.push(Entry {
            binding: sampler.sampler.binding,
            visibility: visibility(&sampler.visibility),
            name: fresh(field(&format!("{}_sampler", sampler.name)), taken),
            doc: format!("The sampler of `{}`.", sampler.name),
            ty: "&'a wgpu::Sampler",
            layout: format!("wgpu::BindingType::Sampler(wgpu::SamplerBindingType::{kind})"),
            resource: |name| format!("wgpu::BindingResource::Sampler(resources.{name})"),
        });
    }
    entries.sort_by_key(|entry| entry.binding);
    entries
}

fn dimension(word: &str) -> &'static str {
    match word {
        "3d" => "D3",
        "cube" => "Cube",
        "cube-array" => "CubeArray",
        "2d-array" => "D2Array",
        _ => "D2",
    }
}

fn bind_group(number: usize, entries: &[Entry]) -> String {
    let mut text =
        String::from(if number == 0 { "/// The uniform buffers.\n" } else { "/// The textures and samplers.\n" });
    let (lifetime, unnamed) = if entries.is_empty() { ("", "") } else { ("<'a>", "<'_>") };
    let _ = writeln!(text, "#[derive(Clone, Copy, Debug)]\npub struct BindGroup{number}{lifetime} {{");
    for Entry { name, doc, ty, .. } in entries {
        let _ = writeln!(text, "/// {doc}\npub {name}: {ty},");
    }
    let _ = writeln!(text, "}}\n\nimpl BindGroup{number}{unnamed} {{");
    text.push_str("/// The entries of the layout.\n");
    let _ = writeln!(text, "pub const LAYOUT: [wgpu::BindGroupLayoutEntry; {}] = [", entries.len());
    for Entry { binding, visibility, layout, .. } in entries {
        let _ = writeln!(
            text,
            "wgpu::BindGroupLayoutEntry {{ binding: {binding}, visibility: {visibility}, ty: {layout}, count: None }},"
        );
    }
    text.push_str("];\n}\n\n");
    let _ = writeln!(
        text,
        "/// The layout of bind group {number}.\npub fn bind_group_{number}_layout(device: &wgpu::Device) -> \
         wgpu::BindGroupLayout {{\ndevice.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {{ label: None, entries: \
         &BindGroup{number}::LAYOUT }})\n}}\n"
    );
    let _ = writeln!(
        text,
        "/// Bind group {number} with its resources.\npub fn bind_group_{number}(device: &wgpu::Device, layout: \
         &wgpu::BindGroupLayout, resources: &BindGroup{number}{unnamed}) -> wgpu::BindGroup {{\nlet _ = \
         resources;\ndevice.create_bind_group(&wgpu::BindGroupDescriptor {{ label: None, layout, entries: &["
    );
    for Entry { binding, name, resource, .. } in entries {
        let _ = writeln!(text, "wgpu::BindGroupEntry {{ binding: {binding}, resource: {} }},", resource(name));
    }
    text.push_str("] })\n}\n\n");
    text
}

fn shader_module(stage: Stage) -> String {
    let (name, constant) = (stage.name(), stage.name().to_uppercase());
    format!(
        "/// The {name} stage on a device.\npub fn {name}_module(device: &wgpu::Device) -> wgpu::ShaderModule \
         {{\ndevice.create_shader_module(wgpu::ShaderModuleDescriptor {{ label: None, source: \
         wgpu::ShaderSource::Wgsl({constant}_WGSL.into()) }})\n}}\n\n"
    )
}

fn pipeline_layout(count: usize) -> String {
    let layouts: Vec<String> = (0..count).map(|number| format!("&bind_group_{number}_layout(device)")).collect();
    let some: Vec<String> = layouts.iter().map(|layout| format!("Some({layout})")).collect();
    format!(
        "/// The layout of the pipeline: {count} bind groups.\npub fn pipeline_layout(device: &wgpu::Device) -> \
         wgpu::PipelineLayout {{\ndevice.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {{ label: None, \
         bind_group_layouts: &[{}], immediate_size: 0 }})\n}}\n\n",
        some.join(", ")
    )
}

fn pipeline(reflection: &Reflection, vertices: &Vertices) -> String {
    let outputs = reflection.outputs.iter().map(|output| output.location + 1).max().unwrap_or(0);
    let buffers: Vec<String> = vertices.structs.iter().map(|one| format!("Some({}::layout())", one.name)).collect();
    format!(
        "/// The state of a pipeline that no shader decides.\n#[derive(Clone, Debug, Default)]\npub struct PipelineState {{\n\
         /// Topology, culling, winding.\npub primitive: wgpu::PrimitiveState,\n\
         /// Depth and stencil, if there are.\npub depth_stencil: Option<wgpu::DepthStencilState>,\n\
         /// Samples of a pixel.\npub multisample: wgpu::MultisampleState,\n}}\n\n\
         /// The number of color outputs.\npub const TARGETS: usize = {outputs};\n\n\
         /// The pipeline, for color targets by number.\npub fn pipeline(device: &wgpu::Device, targets: \
         [Option<wgpu::ColorTargetState>; TARGETS], state: PipelineState) -> wgpu::RenderPipeline {{\n\
         device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {{\nlabel: None,\nlayout: \
         Some(&pipeline_layout(device)),\nvertex: wgpu::VertexState {{ module: &vertex_module(device), entry_point: None, \
         compilation_options: wgpu::PipelineCompilationOptions::default(), buffers: &[{}] }},\nprimitive: \
         state.primitive,\ndepth_stencil: state.depth_stencil,\nmultisample: state.multisample,\nfragment: \
         Some(wgpu::FragmentState {{ module: &fragment_module(device), entry_point: None, compilation_options: \
         wgpu::PipelineCompilationOptions::default(), targets: &targets }}),\nmultiview_mask: None,\ncache: None,\n}})\n}}\n",
        buffers.join(", ")
    )
}

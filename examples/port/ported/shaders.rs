// Written by glisten 0.1.0 from GLSL. Changes are lost.

/// Values as the bytes of a buffer.
#[rustfmt::skip]
#[allow(clippy::all, clippy::cargo, clippy::nursery, clippy::pedantic, clippy::restriction, reason = "nobody wrote it")]
#[allow(dead_code, missing_copy_implementations, missing_docs, nonstandard_style, reason = "nobody wrote it")]
#[allow(unnameable_types, unreachable_pub, unsafe_code, unused, unused_qualifications, unused_results, reason = "nobody wrote it")]
pub mod glisten_memory {
    /// A value that has the same bytes in a buffer on every machine.
    pub trait Bytes {
        /// Appends the bytes.
        fn put(&self, bytes: &mut Vec<u8>);

        /// All bytes.
        fn to_bytes(&self) -> Vec<u8> {
            let mut bytes = Vec::new();
            self.put(&mut bytes);
            bytes
        }
    }

    impl Bytes for f32 {
        fn put(&self, bytes: &mut Vec<u8>) {
            bytes.extend_from_slice(&self.to_le_bytes());
        }
    }

    impl Bytes for i32 {
        fn put(&self, bytes: &mut Vec<u8>) {
            bytes.extend_from_slice(&self.to_le_bytes());
        }
    }

    impl Bytes for u32 {
        fn put(&self, bytes: &mut Vec<u8>) {
            bytes.extend_from_slice(&self.to_le_bytes());
        }
    }

    impl<T: Bytes, const N: usize> Bytes for [T; N] {
        fn put(&self, bytes: &mut Vec<u8>) {
            self.iter().for_each(|one| one.put(bytes));
        }
    }

    impl<T: Bytes> Bytes for [T] {
        fn put(&self, bytes: &mut Vec<u8>) {
            self.iter().for_each(|one| one.put(bytes));
        }
    }

    /// Columns or rows of numbers, four in memory each.
    pub fn padded<T: Copy + Default, const N: usize, const M: usize>(values: [[T; N]; M]) -> [[T; 4]; M] {
        values.map(|value| {
            let mut stored = [T::default(); 4];
            stored[..N].copy_from_slice(&value);
            stored
        })
    }

    /// The rows of a matrix that is given by its columns.
    pub fn transposed<const R: usize, const C: usize>(columns: [[f32; R]; C]) -> [[f32; C]; R] {
        let mut rows = [[0.0; C]; R];
        for (c, column) in columns.iter().enumerate() {
            for (r, value) in column.iter().enumerate() {
                rows[r][c] = *value;
            }
        }
        rows
    }
}

/// The program of `knot.vert` and `knot.frag`.
///
/// A knot under a lamp.
#[rustfmt::skip]
#[allow(clippy::all, clippy::cargo, clippy::nursery, clippy::pedantic, clippy::restriction, reason = "nobody wrote it")]
#[allow(dead_code, missing_copy_implementations, missing_docs, nonstandard_style, reason = "nobody wrote it")]
#[allow(unnameable_types, unreachable_pub, unsafe_code, unused, unused_qualifications, unused_results, reason = "nobody wrote it")]
pub mod knot {
    use super::glisten_memory::Bytes;

    /// The vertex stage in WGSL.
    pub const VERTEX_WGSL: &str = r#"struct Uniforms {
    view: mat4x4<f32>,
    projection: mat4x4<f32>,
    lamp: vec3<f32>,
    ambient: vec3<f32>,
    shininess: f32,
}

struct VertexOutput {
    @builtin(position) position: vec4<f32>,
    @location(0) eye_position: vec3<f32>,
    @location(1) eye_normal: vec3<f32>,
    @location(2) place: vec2<f32>,
}

@group(0) @binding(0) var<uniform> uniforms: Uniforms;

@vertex
fn main(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
) -> VertexOutput {
    let eye = uniforms.view * vec4(position, 1.0);
    let eye_position = eye.xyz;
    let eye_normal = mat3x3<f32>(uniforms.view[0].xyz, uniforms.view[1].xyz, uniforms.view[2].xyz) * normal;
    let place = uv;
    let gl_Position = uniforms.projection * eye;
    return VertexOutput(
        vec4(gl_Position.xy, (gl_Position.z + gl_Position.w) * 0.5, gl_Position.w),
        eye_position,
        eye_normal,
        place,
    );
}
"#;

    /// The fragment stage in WGSL.
    pub const FRAGMENT_WGSL: &str = r#"diagnostic(off, derivative_uniformity);

struct Uniforms {
    view: mat4x4<f32>,
    projection: mat4x4<f32>,
    lamp: vec3<f32>,
    ambient: vec3<f32>,
    shininess: f32,
}

@group(0) @binding(0) var<uniform> uniforms: Uniforms;
@group(1) @binding(0) var pattern: texture_2d<f32>;
@group(1) @binding(1) var pattern_sampler: sampler;

@fragment
fn main(
    @location(0) eye_position: vec3<f32>,
    @location(1) eye_normal: vec3<f32>,
    @location(2) place: vec2<f32>,
) -> @location(0) vec4<f32> {
    let n = normalize(eye_normal);
    let l = normalize(uniforms.lamp - eye_position);
    let h = normalize(l - normalize(eye_position));
    let color = textureSample(pattern, pattern_sampler, place).xyz;
    let diffuse = max(dot(n, l), 0.0);
    let highlight = select(0.0, pow(max(dot(n, h), 0.0), uniforms.shininess), diffuse > 0.0);
    return vec4(color * (uniforms.ambient + diffuse) + 0.6 * highlight, 1.0);
}
"#;

    /// The uniforms outside of blocks.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Uniforms {
        /// `view`
        ///
        /// from the model to the eye
        pub view: [[f32; 4]; 4],
        /// `projection`
        ///
        /// with a depth from -1 to 1
        pub projection: [[f32; 4]; 4],
        /// `lamp`
        ///
        /// in the space of the eye
        pub lamp: [f32; 3],
        /// Nothing reads it.
        pub padding_140: [u32; 1],
        /// `ambient`
        pub ambient: [f32; 3],
        /// `shininess`
        pub shininess: f32,
    }

    impl Uniforms {
        /// The size in bytes.
        pub const SIZE: u64 = 160;

        /// The values of the initializers in GLSL, and zeros.
        pub const fn new() -> Self {
            Self {
                view: [[0.0; 4]; 4],
                projection: [[0.0; 4]; 4],
                lamp: [0.0; 3],
                padding_140: [0; 1],
                ambient: [0.0; 3],
                shininess: 0.0,
            }
        }

        /// Sets `view`.
        pub fn set_view(&mut self, value: [[f32; 4]; 4]) -> &mut Self {
            self.view = super::glisten_memory::padded(value);
            self
        }

        /// Sets `projection`.
        pub fn set_projection(&mut self, value: [[f32; 4]; 4]) -> &mut Self {
            self.projection = super::glisten_memory::padded(value);
            self
        }

        /// Sets `lamp`.
        pub fn set_lamp(&mut self, value: impl Into<[f32; 3]>) -> &mut Self {
            self.lamp = value.into();
            self
        }

        /// Sets `ambient`.
        pub fn set_ambient(&mut self, value: impl Into<[f32; 3]>) -> &mut Self {
            self.ambient = value.into();
            self
        }

        /// Sets `shininess`.
        pub fn set_shininess(&mut self, value: f32) -> &mut Self {
            self.shininess = value;
            self
        }
    }

    impl Default for Uniforms {
        fn default() -> Self {
            Self::new()
        }
    }

    impl Bytes for Uniforms {
        fn put(&self, bytes: &mut Vec<u8>) {
            self.view.put(bytes);
            self.projection.put(bytes);
            self.lamp.put(bytes);
            self.padding_140.put(bytes);
            self.ambient.put(bytes);
            self.shininess.put(bytes);
        }
    }

    const _: () = {
        assert!(core::mem::size_of::<Uniforms>() == 160);
        assert!(core::mem::offset_of!(Uniforms, view) == 0);
        assert!(core::mem::offset_of!(Uniforms, projection) == 64);
        assert!(core::mem::offset_of!(Uniforms, lamp) == 128);
        assert!(core::mem::offset_of!(Uniforms, padding_140) == 140);
        assert!(core::mem::offset_of!(Uniforms, ambient) == 144);
        assert!(core::mem::offset_of!(Uniforms, shininess) == 156);
    };

    /// The attributes of a vertex.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Vertex {
        /// `position`, at location 0.
        pub position: [f32; 3],
        /// `normal`, at location 1.
        pub normal: [f32; 3],
        /// `uv`, at location 2.
        pub uv: [f32; 2],
    }

    impl Vertex {
        /// The bytes from one to the next.
        pub const STRIDE: u64 = 32;
        /// The location, the offset in bytes and the format in WebGPU's words, of each attribute.
        pub const PLACES: [(u32, u64, &'static str); 3] = [(0, 0, "float32x3"), (1, 12, "float32x3"), (2, 24, "float32x2")];
    }

    impl Bytes for Vertex {
        fn put(&self, bytes: &mut Vec<u8>) {
            self.position.put(bytes);
            self.normal.put(bytes);
            self.uv.put(bytes);
        }
    }

    const _: () = {
        assert!(core::mem::size_of::<Vertex>() == 32);
        assert!(core::mem::offset_of!(Vertex, position) == 0);
        assert!(core::mem::offset_of!(Vertex, normal) == 12);
        assert!(core::mem::offset_of!(Vertex, uv) == 24);
    };

    impl Vertex {
        /// The attributes of the buffer's layout.
        pub const ATTRIBUTES: [wgpu::VertexAttribute; 3] = [wgpu::VertexAttribute { format: wgpu::VertexFormat::Float32x3, offset: 0, shader_location: 0 }, wgpu::VertexAttribute { format: wgpu::VertexFormat::Float32x3, offset: 12, shader_location: 1 }, wgpu::VertexAttribute { format: wgpu::VertexFormat::Float32x2, offset: 24, shader_location: 2 }];

        /// The layout of a buffer of these.
        pub const fn layout() -> wgpu::VertexBufferLayout<'static> {
            wgpu::VertexBufferLayout { array_stride: Self::STRIDE, step_mode: wgpu::VertexStepMode::Vertex, attributes: &Self::ATTRIBUTES }
        }
    }

    /// The uniform buffers.
    #[derive(Clone, Copy, Debug)]
    pub struct BindGroup0<'a> {
        /// A buffer of [`Uniforms`].
        pub uniforms: &'a wgpu::Buffer,
    }

    impl BindGroup0<'_> {
        /// The entries of the layout.
        pub const LAYOUT: [wgpu::BindGroupLayoutEntry; 1] = [
            wgpu::BindGroupLayoutEntry { binding: 0, visibility: wgpu::ShaderStages::VERTEX.union(wgpu::ShaderStages::FRAGMENT), ty: wgpu::BindingType::Buffer { ty: wgpu::BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: core::num::NonZeroU64::new(Uniforms::SIZE) }, count: None },
        ];
    }

    /// The layout of bind group 0.
    pub fn bind_group_0_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &BindGroup0::LAYOUT })
    }

    /// Bind group 0 with its resources.
    pub fn bind_group_0(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, resources: &BindGroup0<'_>) -> wgpu::BindGroup {
        let _ = resources;
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: resources.uniforms.as_entire_binding() },
                ] })
    }

    /// The textures and samplers.
    #[derive(Clone, Copy, Debug)]
    pub struct BindGroup1<'a> {
        /// The texture of `pattern`, a `sampler2D`.
        pub pattern: &'a wgpu::TextureView,
        /// The sampler of `pattern`.
        pub pattern_sampler: &'a wgpu::Sampler,
    }

    impl BindGroup1<'_> {
        /// The entries of the layout.
        pub const LAYOUT: [wgpu::BindGroupLayoutEntry; 2] = [
            wgpu::BindGroupLayoutEntry { binding: 0, visibility: wgpu::ShaderStages::FRAGMENT, ty: wgpu::BindingType::Texture { sample_type: wgpu::TextureSampleType::Float { filterable: true }, view_dimension: wgpu::TextureViewDimension::D2, multisampled: false }, count: None },
            wgpu::BindGroupLayoutEntry { binding: 1, visibility: wgpu::ShaderStages::FRAGMENT, ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering), count: None },
        ];
    }

    /// The layout of bind group 1.
    pub fn bind_group_1_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &BindGroup1::LAYOUT })
    }

    /// Bind group 1 with its resources.
    pub fn bind_group_1(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, resources: &BindGroup1<'_>) -> wgpu::BindGroup {
        let _ = resources;
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(resources.pattern) },
                    wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(resources.pattern_sampler) },
                ] })
    }

    /// The vertex stage on a device.
    pub fn vertex_module(device: &wgpu::Device) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source: wgpu::ShaderSource::Wgsl(VERTEX_WGSL.into()) })
    }

    /// The fragment stage on a device.
    pub fn fragment_module(device: &wgpu::Device) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source: wgpu::ShaderSource::Wgsl(FRAGMENT_WGSL.into()) })
    }

    /// The layout of the pipeline: 2 bind groups.
    pub fn pipeline_layout(device: &wgpu::Device) -> wgpu::PipelineLayout {
        device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor { label: None, bind_group_layouts: &[Some(&bind_group_0_layout(device)), Some(&bind_group_1_layout(device))], immediate_size: 0 })
    }

    /// The state of a pipeline that no shader decides.
    #[derive(Clone, Debug, Default)]
    pub struct PipelineState {
        /// Topology, culling, winding.
        pub primitive: wgpu::PrimitiveState,
        /// Depth and stencil, if there are.
        pub depth_stencil: Option<wgpu::DepthStencilState>,
        /// Samples of a pixel.
        pub multisample: wgpu::MultisampleState,
    }

    /// The number of color outputs.
    pub const TARGETS: usize = 1;

    /// The pipeline, for color targets by number.
    pub fn pipeline(device: &wgpu::Device, targets: [Option<wgpu::ColorTargetState>; TARGETS], state: PipelineState) -> wgpu::RenderPipeline {
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: None,
                layout: Some(&pipeline_layout(device)),
                vertex: wgpu::VertexState { module: &vertex_module(device), entry_point: None, compilation_options: wgpu::PipelineCompilationOptions::default(), buffers: &[Some(Vertex::layout())] },
                primitive: state.primitive,
                depth_stencil: state.depth_stencil,
                multisample: state.multisample,
                fragment: Some(wgpu::FragmentState { module: &fragment_module(device), entry_point: None, compilation_options: wgpu::PipelineCompilationOptions::default(), targets: &targets }),
                multiview_mask: None,
                cache: None,
        })
    }
}

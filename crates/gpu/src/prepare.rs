//! [`Prepared`]: a scene with its modules, layouts, buffers and pipelines on the device, ready to be drawn any number
//! of times.
//!
//! *Holds:* each bind group layout lists exactly what the interface reflects, including inactive resources, and its
//! bindings count from 0 without gaps. wgpu renumbers the bindings of a pass-through module's layout, so a gap would
//! silently bind the wrong resource; it is rejected here.

use super::device::feature_of;
use super::textures::{self, Bound};
use super::{Error, Foreign, Gpu, Via, multisample_upload};
use glisten_emit::{self as emit, Conventions, Emitted, FloatWidth, Target};
use glisten_front::hir::{SamplerDim, Stage, Type};
use glisten_front::link::{Program, SlotBinding};
use glisten_plan::bindings::{Binding, GROUPS, What, bindings, conventions, refuse_levels, refuse_wraps, targets};
use glisten_plan::states::{depth_stencil, primitive_state};
use glisten_plan::vertices::{self, Rows};
use glisten_plan::visibility::Visibility;
use glisten_plan::{assembly, beyond, slots, sprites, uniforms};
use glisten_scene::{Draw, Framebuffer, Scene, State};
use std::sync::Arc;

/// A scene on the device.
pub struct Prepared {
    pub(super) framebuffer: Framebuffer,
    pub(super) draws: Vec<PreparedDraw>,
}

/// A draw on the device.
pub(super) struct PreparedDraw {
    pub(super) pipeline: wgpu::RenderPipeline,
    /// The bind groups, by group number.
    pub(super) groups: Vec<wgpu::BindGroup>,
    pub(super) vertex_buffers: Vec<wgpu::Buffer>,
    /// The index buffer, if there is one.
    pub(super) indices: Option<wgpu::Buffer>,
    /// The number of vertices, or of indices.
    pub(super) count: u32,
    pub(super) instances: u32,
    /// The constant color of blending.
    pub(super) constant: Option<wgpu::Color>,
}

/// Returns the code of a stage of a draw.
pub(super) type Modules<'a> = &'a dyn Fn(&Draw, Stage) -> Result<Emitted, Error>;

/// The modules that replace the stages of a draw, by their index.
type Replaced = [Option<usize>; 2];

/// Who wrote the modules.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Origin {
    /// The emitter: they see what the reflection says.
    Emitted,
    /// Someone else, or a test that has edited them.
    Other,
}

/// The stages of a draw.
const STAGES: [Stage; 2] = [Stage::Vertex, Stage::Fragment];

pub(super) fn emitted(framebuffer: &Framebuffer, draw: &Draw, stage: Stage, target: Target) -> Result<Emitted, Error> {
    emit::emit(&draw.program, stage, target, &conventions(framebuffer, draw, target)).map_err(Error::Emit)
}

/// A pipeline and what it was created for: draws of one program in one state share it.
struct Made {
    program: Arc<Program>,
    state: State,
    conventions: Conventions,
    instanced: Vec<bool>,
    replaced: Replaced,
    pipeline: wgpu::RenderPipeline,
    layouts: Vec<wgpu::BindGroupLayout>,
}

impl Gpu {
    /// Emits every program of a scene and puts everything on the device.
    ///
    /// # Errors
    /// [`Error::Emit`] if the target cannot represent a program, [`Error::Refused`] if wgpu or the driver rejects it.
    pub fn prepare(&self, scene: &Scene, via: Via) -> Result<Prepared, Error> {
        self.prepare_in(scene, via, FloatWidth::Single)
    }

    /// Prepares a scene whose programs compute with floats of a width.
    ///
    /// # Errors
    /// Those of [`Gpu::prepare`], and [`Error::Unsupported`] if the device does not have that width.
    pub fn prepare_in(&self, scene: &Scene, via: Via, floats: FloatWidth) -> Result<Prepared, Error> {
        let target = match via {
            Via::Spirv => Target::Spirv,
            Via::Wgsl => Target::Wgsl,
        };
        self.require(feature_of(floats), &format!("{} in shaders", floats.ty()))?;
        let code = |draw: &Draw, stage| {
            let conventions = Conventions { floats, ..conventions(&scene.framebuffer, draw, target) };
            emit::emit(&draw.program, stage, target, &conventions).map_err(Error::Emit)
        };
        self.prepare_replaced(scene, (target, Origin::Emitted), &|_| [None; 2], &|_, draw, stage| code(draw, stage))
    }

    /// Prepares a scene with modules of others in place of the emitted ones. Those of the other form are not used.
    ///
    /// A vertex module may leave out a varying that nobody reads. `lean` gives a program without the inputs that it declares
    /// and never reads; the fragment stage of such a program then takes the place of the emitted one.
    ///
    /// # Errors
    /// Those of [`Gpu::prepare`], and [`Error::Foreign`] if the interface of a module is not that of the emitted one.
    pub fn prepare_foreign(
        &self,
        scene: &Scene,
        via: Via,
        foreign: &[Foreign],
        lean: &dyn Fn(&Program) -> Program,
    ) -> Result<Prepared, Error> {
        let target = match via {
            Via::Spirv => Target::Spirv,
            Via::Wgsl => Target::Wgsl,
        };
        // The last one that is given for a stage counts.
        let of = |number: usize, stage: Stage| {
            foreign.iter().rposition(|module| {
                module.via() == via && module.stage == stage && module.draw.is_none_or(|draw| draw == number)
            })
        };
        let code = |replaced: Replaced, draw: &Draw, stage: Stage| {
            let [vertex, fragment] = replaced.map(|index| index.and_then(|index| foreign.get(index)));
            // All forms of a stage that can be read back.
            let forms = |stage: Stage| {
                let all = [target, Target::Wgsl].map(|target| emitted(&scene.framebuffer, draw, stage, target));
                all.into_iter().filter_map(Result::ok)
            };
            let lean_fragment = || {
                let program = lean(&draw.program);
                let conventions = conventions(&scene.framebuffer, draw, target);
                emit::emit(&program, Stage::Fragment, target, &conventions).map_err(Error::Emit)
            };
            match (stage, vertex, fragment) {
                (Stage::Vertex, Some(vertex), Some(fragment)) => {
                    vertex.code_instead_of(&draw.program.name, forms(stage), Some(fragment.read_by_it()))
                }
                (Stage::Vertex, Some(vertex), None) => {
                    let read = Foreign::inputs_of([lean_fragment()?].into_iter().chain(forms(Stage::Fragment)));
                    vertex.code_instead_of(&draw.program.name, forms(stage), read)
                }
                (Stage::Fragment, _, Some(fragment)) => {
                    fragment.code_instead_of(&draw.program.name, forms(stage), None)
                }
                (Stage::Fragment, Some(vertex), None) if vertex.leaves_out(forms(Stage::Vertex)) => lean_fragment(),
                _ => emitted(&scene.framebuffer, draw, stage, target),
            }
        };
        self.prepare_replaced(scene, (target, Origin::Emitted), &|number| STAGES.map(|stage| of(number, stage)), &code)
    }

    /// Prepares a scene with SPIR-V after `edit` has changed the emitted words of each stage, in the order of the
    /// draws, vertex stages first. It is for tests that plant faults. Draws of one program in one state share one
    /// call.
    ///
    /// # Errors
    /// Those of [`Gpu::prepare`].
    ///
    /// # Safety
    /// The driver runs the words as they are, and its behavior is undefined if they are not a valid module: check
    /// them with `spirv-val` first.
    #[doc(hidden)]
    #[cfg(feature = "edited-modules")]
    #[expect(unsafe_code, reason = "nothing here can check what `edit` makes")]
    pub unsafe fn prepare_edited(
        &self,
        scene: &Scene,
        edit: &dyn Fn(Stage, Vec<u32>) -> Vec<u32>,
    ) -> Result<Prepared, Error> {
        let edited = |draw: &Draw, stage: Stage| match emitted(&scene.framebuffer, draw, stage, Target::Spirv)? {
            Emitted::Words(words) => Ok(Emitted::Words(edit(stage, words))),
            text @ Emitted::Text(_) => Ok(text),
        };
        self.prepare_with(scene, Target::Spirv, &edited)
    }

    /// Prepares a scene with modules for a target, which follow the conventions of [`conventions`].
    #[cfg(any(test, feature = "edited-modules"))]
    pub(super) fn prepare_with(&self, scene: &Scene, target: Target, modules: Modules<'_>) -> Result<Prepared, Error> {
        self.prepare_replaced(scene, (target, Origin::Other), &|_| [None; 2], &|_, draw, stage| modules(draw, stage))
    }

    fn prepare_replaced(
        &self,
        scene: &Scene,
        (target, origin): (Target, Origin),
        replaced: &dyn Fn(usize) -> Replaced,
        code: &dyn Fn(Replaced, &Draw, Stage) -> Result<Emitted, Error>,
    ) -> Result<Prepared, Error> {
        self.require(wgpu::Features::DEPTH32FLOAT_STENCIL8, "a depth buffer with stencil")?;
        let limit = self.limits.max_texture_dimension_2d;
        let Framebuffer { width, height, .. } = scene.framebuffer;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(Error::Refused(format!(
                "a framebuffer of {width} x {height} pixels; this adapter takes 1 to {limit} in each direction"
            )));
        }
        let mut made = Vec::new();
        let mut draws = Vec::new();
        for (number, draw) in scene.draws.iter().enumerate() {
            let replaced = replaced(number);
            let origin = if replaced == [None; 2] { origin } else { Origin::Other };
            let modules: Modules<'_> = &|draw, stage| code(replaced, draw, stage);
            let kind = (target, origin, replaced);
            draws.push(self.guarded(|| self.prepare_draw(&scene.framebuffer, draw, kind, modules, &mut made))?);
        }
        Ok(Prepared { framebuffer: scene.framebuffer, draws })
    }

    fn prepare_draw(
        &self,
        framebuffer: &Framebuffer,
        draw: &Draw,
        (target, origin, replaced): (Target, Origin, Replaced),
        modules: Modules<'_>,
        made: &mut Vec<Made>,
    ) -> Result<PreparedDraw, Error> {
        let program = &draw.program;
        let sprites = sprites::applies(draw, target);
        beyond::refuse(draw)?;
        sprites::refuse(draw, target)?;
        refuse_levels(draw)?;
        refuse_wraps(draw)?;
        refuse_samples(draw)?;
        let bindings = bindings(program, sprites)?;
        let conventions = conventions(framebuffer, draw, target);
        let rows = if sprites { vertices::rows_of_points(draw) } else { vertices::rows(draw) };
        let instanced: Vec<bool> = rows.iter().map(|rows| rows.step == wgpu::VertexStepMode::Instance).collect();
        let known = made.iter().position(|made| {
            let is_alike = made.state == draw.state && made.instanced == instanced && made.replaced == replaced;
            Arc::ptr_eq(&made.program, program) && is_alike && made.conventions == conventions
        });
        let index = match known {
            Some(index) => index,
            None => {
                let [vertex, fragment] = STAGES.map(|stage| self.module(draw, stage, modules));
                let modules = [vertex?, fragment?];
                let visibility = match origin {
                    Origin::Emitted => Visibility::of(program, &conventions),
                    Origin::Other => Visibility::of_any_code(),
                };
                let layouts = self.layouts(&bindings, &visibility);
                let primitive = if sprites { sprites::primitive_state() } else { primitive_state(&draw.state) };
                let pipeline = self.pipeline(framebuffer, draw, primitive, &modules, &layouts, &rows);
                let (program, state) = (Arc::clone(program), draw.state);
                made.push(Made { program, state, conventions, instanced, replaced, pipeline, layouts });
                made.len() - 1
            }
        };
        let Made { pipeline, layouts, .. } = &made[index];
        let groups = self.bind(framebuffer, draw, &bindings, layouts)?;
        let constant = draw.state.blend.map(|blend| blend.one_constant().map(f64::from));
        let constant = constant.map(|[r, g, b, a]| wgpu::Color { r, g, b, a });
        if sprites {
            let vertex_buffers = rows.iter().map(|rows| self.buffer(&rows.bytes, wgpu::BufferUsages::VERTEX)).collect();
            let (count, instances) = (sprites::CORNERS, sprites::count(draw));
            let pipeline = pipeline.clone();
            return Ok(PreparedDraw { pipeline, groups, vertex_buffers, indices: None, count, instances, constant });
        }
        let state = &draw.state;
        let list = assembly::list(state.primitive, draw.vertex_count, draw.indices.as_deref(), state.provoking_last);
        let count = list.as_ref().map_or(draw.vertex_count, |list| list.len() as u32);
        Ok(PreparedDraw {
            pipeline: pipeline.clone(),
            groups,
            vertex_buffers: rows.iter().map(|rows| self.buffer(&rows.bytes, wgpu::BufferUsages::VERTEX)).collect(),
            indices: list.map(|list| self.buffer(bytemuck::cast_slice(&list), wgpu::BufferUsages::INDEX)),
            count,
            instances: draw.instances,
            constant,
        })
    }

    /// A buffer with these bytes, padded to whole words. One that wgpu refuses is an error of the scope around it; a buffer
    /// that is mapped at its creation would panic then.
    fn buffer(&self, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let mut bytes = if bytes.is_empty() { vec![0; 16] } else { bytes.to_vec() };
        bytes.resize(bytes.len().next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT as usize), 0);
        let usage = usage | wgpu::BufferUsages::COPY_DST;
        let size = bytes.len() as u64;
        let descriptor = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
        let buffer = self.device.create_buffer(&descriptor);
        self.queue.write_buffer(&buffer, 0, &bytes);
        buffer
    }

    /// Creates the module of a stage's code.
    fn module(&self, draw: &Draw, stage: Stage, modules: Modules<'_>) -> Result<wgpu::ShaderModule, Error> {
        let program = &draw.program;
        if program.stage(stage).is_none() {
            return Err(Error::Refused(format!("program `{}` has no {} stage", program.name, stage.name())));
        }
        match modules(draw, stage)? {
            Emitted::Text(text) => Ok(self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(&program.name),
                source: wgpu::ShaderSource::Wgsl(text.into()),
            })),
            Emitted::Words(words) => {
                self.require(wgpu::Features::PASSTHROUGH_SHADERS, "modules that pass through to the driver")?;
                Ok(self.passthrough(&program.name, &words))
            }
        }
    }

    #[expect(unsafe_code, reason = "the words are to run as they are, not as wgpu's naga would write them anew")]
    fn passthrough(&self, name: &str, words: &[u32]) -> wgpu::ShaderModule {
        let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
            label: Some(name),
            entry_points: vec![wgpu::PassthroughShaderEntryPoint { name: "main".into(), workgroup_size: (0, 0, 0) }]
                .into(),
            spirv: Some(words.into()),
            ..wgpu::ShaderModuleDescriptorPassthrough::default()
        };
        // SAFETY: naga's writer wrote the words, from a module that its validator accepted; or `spirv-val` accepted the
        // module of another translator, whose interface is that of naga's (see `foreign`). The pipeline's layout is
        // explicit and lists exactly the bindings that the module declares (see `bindings`).
        unsafe { self.device.create_shader_module_passthrough(descriptor) }
    }

    fn layouts(&self, bindings: &[Binding], visibility: &Visibility) -> Vec<wgpu::BindGroupLayout> {
        (0..GROUPS as u32)
            .map(|group| {
                let entries: Vec<_> = bindings
                    .iter()
                    .filter(|binding| binding.slot.group == group)
                    .map(|binding| wgpu::BindGroupLayoutEntry {
                        binding: binding.slot.binding,
                        visibility: visibility.stages(binding.slot),
                        ty: binding.what.layout(),
                        count: None,
                    })
                    .collect();
                self.device
                    .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
            })
            .collect()
    }

    fn pipeline(
        &self,
        framebuffer: &Framebuffer,
        draw: &Draw,
        primitive: wgpu::PrimitiveState,
        [vertex, fragment]: &[wgpu::ShaderModule; 2],
        layouts: &[wgpu::BindGroupLayout],
        rows: &[Rows],
    ) -> wgpu::RenderPipeline {
        let layouts: Vec<Option<&wgpu::BindGroupLayout>> = layouts.iter().map(Some).collect();
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &layouts,
            immediate_size: 0,
        });
        let buffers: Vec<_> = rows
            .iter()
            .map(|rows| {
                Some(wgpu::VertexBufferLayout {
                    array_stride: rows.stride,
                    step_mode: rows.step,
                    attributes: &rows.columns,
                })
            })
            .collect();
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&draw.program.name),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: vertex,
                entry_point: None,
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &buffers,
            },
            primitive,
            depth_stencil: Some(depth_stencil(&draw.state)),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: fragment,
                entry_point: None,
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &targets(framebuffer, draw),
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn bind(
        &self,
        framebuffer: &Framebuffer,
        draw: &Draw,
        bindings: &[Binding],
        layouts: &[wgpu::BindGroupLayout],
    ) -> Result<Vec<wgpu::BindGroup>, Error> {
        let texels: Vec<u32> = draw.textures.iter().map(|texture| slots::texels(texture.as_deref())).collect();
        let mut buffers: Vec<(SlotBinding, wgpu::Buffer)> =
            uniforms::pack(&draw.program, &draw.uniforms, framebuffer.height, &texels)
                .into_iter()
                .map(|packed| (packed.slot, self.buffer(&packed.bytes, wgpu::BufferUsages::UNIFORM)))
                .collect();
        let viewport = sprites::viewport(framebuffer);
        buffers.push((sprites::slot(&draw.program), self.buffer(&viewport, wgpu::BufferUsages::UNIFORM)));
        let mut bound: Vec<(SlotBinding, SlotBinding, Bound)> = Vec::new();
        for (index, slot) in draw.program.interface.samplers.iter().enumerate() {
            let Type::Sampler(kind) = draw.program.types.get(slot.ty) else { continue };
            let texture = draw.textures.get(index).and_then(Option::as_deref);
            bound.push((slot.texture, slot.sampler, textures::bind(self, kind, texture)?));
        }
        let resource = |binding: &Binding| match binding.what {
            What::Uniforms => {
                buffers.iter().find(|(slot, _)| *slot == binding.slot).map(|(_, buffer)| buffer.as_entire_binding())
            }
            What::Texture(_) => bound
                .iter()
                .find(|(texture, ..)| *texture == binding.slot)
                .map(|(_, _, bound)| wgpu::BindingResource::TextureView(&bound.view)),
            What::Sampler(_) => bound
                .iter()
                .find(|(_, sampler, _)| *sampler == binding.slot)
                .map(|(_, _, bound)| wgpu::BindingResource::Sampler(&bound.sampler)),
        };
        Ok(layouts
            .iter()
            .enumerate()
            .map(|(group, layout)| {
                let entries: Vec<_> = bindings
                    .iter()
                    .filter(|binding| binding.slot.group as usize == group)
                    .filter_map(|binding| {
                        let resource = resource(binding)?;
                        Some(wgpu::BindGroupEntry { binding: binding.slot.binding, resource })
                    })
                    .collect();
                self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
            })
            .collect())
    }
}

/// Reports multisample textures that WebGPU cannot hold.
fn refuse_samples(draw: &Draw) -> Result<(), Error> {
    for (slot, texture) in draw.program.interface.samplers.iter().zip(&draw.textures) {
        if let Type::Sampler(kind) = draw.program.types.get(slot.ty)
            && kind.dim == SamplerDim::Multisample
            && slot.active
        {
            multisample_upload::refuse(kind, texture.as_deref())?;
        }
    }
    Ok(())
}

//! Emitted code, drawn without a GPU: naga reads it and writes GLSL, which glisten reads and the reference draws.
//!
//! ```text
//!  program ──► WGSL, SPIR-V ──► naga ──► GLSL 4.50 ──► the same picture, or one inside of the envelope?
//!  uniforms ──► bytes by the reflection ──► values by naga's offsets ──┘
//! ```
//!
//! *In:* a program that has been drawn, and modules of naga for its stages. *Out:* a sentence where another picture is drawn. *Holds:* uniforms
//! go as bytes, as a host writes them: an offset that the code does not have shows. *Not done here:* textures that emitted code has in another
//! shape, such as those of one dimension or of buffers; what naga's GLSL lacks.

use super::drawn::{Bits, Drawn, Read, compiler, inside, picture_of};
use glisten::scene::Scene;
use glisten::verify::Runner;
use glisten_front::hir::{ScalarValue, Type};
use glisten_front::link::SlotBinding;
use glisten_front::{Source, Stage};
use glisten_plan::{slots, uniforms};
use glisten_reference::Precision;
use glisten_scene::Draw;
use glisten_verify::verify;
use glisten_verify::verify::{Cpu, Failure};
use naga::back::glsl;
use naga::proc::BoundsCheckPolicies;
use naga::{Handle, Module, ScalarKind, TypeInner};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

type Held = Result<(), String>;

/// A stage as naga writes it.
struct Written {
    source: Source,
    /// The names of blocks, with the bindings and types of their variables.
    blocks: Vec<(String, SlotBinding, Handle<naga::Type>)>,
    /// The names of textures, with their bindings.
    textures: Vec<(String, SlotBinding)>,
}

/// Whether the stages draw the picture of the program.
pub(super) fn same(drawn: &Drawn<'_>, stages: &[Read]) -> Held {
    let Some(draw) = drawn.scene.draws.first() else { return Ok(()) };
    let leave_out = |why| {
        drawn.leave_out(why);
        Ok(())
    };
    if draw.program.stages.len() > 2 {
        return leave_out("no target has a geometry stage");
    }
    if stages.len() != 2 {
        return leave_out("a stage is refused, or naga has a limit");
    }
    let has_other_shape = draw.program.interface.samplers.iter().any(|slot| match draw.program.types.get(slot.ty) {
        Type::Sampler(ty) => !SHAPES.contains(&ty.name().as_str()),
        _ => true,
    });
    if has_other_shape {
        return leave_out("a texture has another shape in emitted code");
    }
    let height = drawn.scene.framebuffer.height;
    let Some(written) = stages.iter().map(|one| written(one, height)).collect::<Option<Vec<Written>>>() else {
        return leave_out("naga cannot write the module as GLSL");
    };
    let sources: Vec<Source> = written.iter().map(|one| one.source.clone()).collect();
    let texts = || sources.iter().map(|source| format!("{}\n", source.text)).collect::<String>();
    let compilation = compiler().compile(&sources);
    let Some(program) = compilation.program else {
        let error = compilation.diagnostics.iter().find(|one| one.is_error());
        let message = error.map_or(String::new(), |one| format!("{}: {}", one.code.id, one.message));
        // naga writes comparisons that gather as others.
        let is_limit = message.contains("`textureGather");
        if is_limit {
            return leave_out("naga writes another comparison that gathers");
        }
        return Err(format!("GLSL of naga is not accepted: {message}\n{}", texts()));
    };
    let other = with(draw, program, stages, &written, height);
    let mut scene = Scene { draws: vec![other], ..drawn.scene.clone() };
    // `gl_FragData` has an output for each that there may be.
    let last = scene.draws.iter().flat_map(|draw| &draw.program.interface.outputs).map(|one| one.location).max();
    scene.framebuffer.attachments = scene.framebuffer.attachments.max(last.map_or(1, |last| last + 1));
    judged(drawn, scene).map_err(|message| format!("{message}\n{}", texts()))
}

/// The samplers that emitted code has in their own shape.
const SHAPES: [&str; 8] = [
    "sampler2D",
    "sampler3D",
    "samplerCube",
    "sampler2DArray",
    "sampler2DShadow",
    "sampler2DArrayShadow",
    "isampler2D",
    "usampler2D",
];

/// A stage as GLSL; none if naga cannot write it.
fn written(read: &Read, height: u32) -> Option<Written> {
    let (shader_stage, name) = match read.stage {
        Stage::Vertex => (naga::ShaderStage::Vertex, "a.vert"),
        Stage::Fragment => (naga::ShaderStage::Fragment, "a.frag"),
        Stage::Geometry => return None,
    };
    let entry_point = read.module.entry_points.first()?.name.clone();
    let options = glsl::Options { version: glsl::Version::Desktop(450), ..glsl::Options::default() };
    let pipeline = glsl::PipelineOptions { shader_stage, entry_point, multiview: None };
    let write = || {
        let mut text = String::new();
        let policies = BoundsCheckPolicies::default();
        let mut writer = glsl::Writer::new(&mut text, &read.module, &read.info, &options, &pipeline, policies).ok()?;
        let reflection = writer.write().ok()?;
        drop(writer);
        Some((text, reflection))
    };
    // naga 30.0.1 panics where a lookup has an offset.
    let (text, reflection) = catch_unwind(AssertUnwindSafe(write)).ok().flatten()?;
    let slot = |handle: Handle<naga::GlobalVariable>| {
        let binding = read.module.global_variables[handle].binding.as_ref()?;
        Some(SlotBinding { group: binding.group, binding: binding.binding })
    };
    let blocks = reflection
        .uniforms
        .iter()
        .filter_map(|(handle, name)| Some((name.clone(), slot(*handle)?, read.module.global_variables[*handle].ty)));
    let textures =
        reflection.texture_mapping.iter().filter_map(|(name, mapping)| Some((name.clone(), slot(mapping.texture)?)));
    let (blocks, textures) = (blocks.collect(), textures.collect());
    // naga turns the picture upside down, for OpenGL; here, what is turned is the place and the derivative instead.
    let turned = format!("vec4(gl_FragCoord.x, {height}.0 - gl_FragCoord.y, gl_FragCoord.zw)");
    let text = text.replace("vec2(-gl_Position.y, gl_Position.z", "vec2(gl_Position.y, gl_Position.z");
    let text = replaced(&replaced(&text, "gl_FragCoord", &turned), "dFdy", "-dFdy");
    Some(Written { source: Source { name: name.to_owned(), text: text.into(), stage: read.stage }, blocks, textures })
}

/// A text with another one where a name begins.
fn replaced(text: &str, name: &str, other: &str) -> String {
    let mut parts = text.split(name);
    let mut made = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let is_inner = made.ends_with(|letter: char| letter.is_ascii_alphanumeric() || letter == '_');
        made.push_str(if is_inner { name } else { other });
        made.push_str(part);
    }
    made
}

/// The draw with the program that naga wrote.
fn with(draw: &Draw, program: glisten_front::Program, stages: &[Read], written: &[Written], height: u32) -> Draw {
    let (old, new) = (&draw.program.interface, &program.interface);
    let texels: Vec<u32> = draw.textures.iter().map(|texture| slots::texels(texture.as_deref())).collect();
    let buffers = uniforms::pack(&draw.program, &draw.uniforms, height, &texels);
    let mut values: Vec<Vec<ScalarValue>> = Vec::new();
    for root in &new.roots {
        let found = stages.iter().zip(written).find_map(|(read, written)| {
            let (_, slot, ty) = written.blocks.iter().find(|(name, ..)| *name == root.name)?;
            let buffer = buffers.iter().find(|buffer| buffer.slot == *slot)?;
            let mut flat = Vec::new();
            flatten(&read.module, *ty, &buffer.bytes, 0, &mut flat);
            Some(flat)
        });
        let len = program.types.flat_len(root.ty) as usize;
        let mut found = found.unwrap_or_default();
        found.resize(len, ScalarValue::Uint(0));
        values.push(found);
    }
    let attributes = new.attributes.iter().map(|attribute| {
        let index = old.attributes.iter().position(|known| known.location == attribute.location)?;
        draw.attributes.get(index).cloned().flatten()
    });
    let textures = new.samplers.iter().map(|slot| {
        let mut all = written.iter().flat_map(|one| &one.textures);
        let (_, binding) = all.find(|(name, _)| *name == slot.name)?;
        let index = old.samplers.iter().position(|known| known.texture == *binding)?;
        draw.textures.get(index).cloned().flatten()
    });
    let (attributes, textures) = (attributes.collect(), textures.collect());
    Draw {
        attributes,
        textures,
        uniforms: values,
        dynamic: Vec::new(),
        fixed: None,
        program: Arc::new(program),
        ..draw.clone()
    }
}

/// The scalars of a type in bytes, in the order of GLSL, by naga's offsets.
fn flatten(module: &Module, ty: Handle<naga::Type>, bytes: &[u8], offset: u32, flat: &mut Vec<ScalarValue>) {
    let word = |offset: u32| {
        let four = bytes.get(offset as usize..offset as usize + 4).and_then(|four| four.try_into().ok());
        u32::from_ne_bytes(four.unwrap_or_default())
    };
    let value = |kind: ScalarKind, offset: u32| match kind {
        ScalarKind::Sint => ScalarValue::Int(word(offset) as i32),
        ScalarKind::Uint => ScalarValue::Uint(word(offset)),
        ScalarKind::Bool => ScalarValue::Bool(word(offset) != 0),
        _ => ScalarValue::Float(f32::from_bits(word(offset))),
    };
    match &module.types[ty].inner {
        TypeInner::Scalar(scalar) => flat.push(value(scalar.kind, offset)),
        TypeInner::Vector { size, scalar } => {
            flat.extend((0..*size as u32).map(|component| value(scalar.kind, offset + component * 4)));
        }
        TypeInner::Matrix { columns, rows, scalar } => {
            let stride = if *rows as u32 == 2 { 8 } else { 16 };
            for column in 0..*columns as u32 {
                flat.extend((0..*rows as u32).map(|row| value(scalar.kind, offset + column * stride + row * 4)));
            }
        }
        TypeInner::Array { base, size: naga::ArraySize::Constant(size), stride } => {
            (0..size.get()).for_each(|index| flatten(module, *base, bytes, offset + index * stride, flat));
        }
        TypeInner::Struct { members, .. } => {
            members.iter().for_each(|member| flatten(module, member.ty, bytes, offset + member.offset, flat));
        }
        _ => {}
    }
}

/// A runner that draws another scene.
struct Other<'s> {
    scene: &'s Scene,
    /// How many attachments are compared.
    attachments: usize,
}

impl Runner for Other<'_> {
    fn name(&self) -> &'static str {
        "f32"
    }

    fn draw(&self, _: &Scene) -> Result<verify::Drawn, Failure> {
        let mut drawn = Cpu::new(Precision::F32).draw(self.scene)?;
        drawn.picture.attachments.truncate(self.attachments);
        Ok(drawn)
    }
}

/// The same bits, or numbers inside of the envelope.
fn judged(drawn: &Drawn<'_>, scene: Scene) -> Held {
    let attachments = drawn.scene.framebuffer.attachments as usize;
    let picture = picture_of(&scene, Precision::F32, attachments)?;
    if drawn.single.difference(&Bits::of(&picture)).is_ok() || drawn.is_inside(&picture)? {
        return Ok(());
    }
    inside(drawn, &Other { scene: &scene, attachments })
}

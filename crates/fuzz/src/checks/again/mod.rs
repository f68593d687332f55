//! Emitted code, drawn without a GPU: another program reads it and writes GLSL, which glisten reads and the reference draws.
//!
//! ```text
//!  program ──► WGSL, SPIR-V ──► naga or spirv-cross ──► GLSL 4.50 ──► the same picture, or one inside of the envelope?
//!  program ──► GLSL for Vulkan ──► glslang ──► spirv-cross ──┘
//!  uniforms ──► bytes by the reflection ──► values by the offsets of the emitted code ──┘
//! ```
//!
//! *In:* a program that has been drawn, and its stages as they were emitted. *Out:* a sentence where another picture is drawn. *Holds:* one
//! way back that draws the picture is enough, since all read the same code; the table says which way it was, and which one failed. Uniforms go as bytes, as a
//! host writes them: an offset that the code does not have shows. *Not done here:* geometry stages of WGSL and SPIR-V, which have none.
//!
//! | file | contents |
//! | --- | --- |
//! | `naga` | GLSL that naga writes |
//! | `cross` | GLSL that spirv-cross writes, where it is installed |
//! | `host` | attributes, uniforms and textures for the program that came back |
//! | `limits` | what both cannot write, and what they write wrong |

mod cross;
mod host;
mod limits;
mod naga;

use super::drawn::{Bits, Drawn, Emission, Origin, compiler, inside, picture_of};
use glisten::scene::Scene;
use glisten::verify::Runner;
use glisten_front::hir::SamplerDim;
use glisten_front::link::SlotBinding;
use glisten_front::{Source, Stage};
use glisten_reference::Precision;
use glisten_scene::Draw;
use glisten_scene::picture::Picture;
use glisten_verify::verify;
use glisten_verify::verify::{Cpu, Failure};

type Held = Result<(), String>;

/// Why there is no code of a stage.
const NO_GEOMETRY: &str = "no target but GLSL has a geometry stage";

/// By how much numbers may differ that glslang has evaluated: relative to the number, or to 1.
const CLOSE: f64 = 1e-5;

/// A way from emitted code to a text that glisten reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Naga,
    Cross,
    /// spirv-cross with a variable for each value, so that it moves none.
    Plain,
}

impl Way {
    /// Its name in the table.
    fn name(self) -> &'static str {
        match self {
            Self::Naga => "naga",
            Self::Cross => "spirv-cross",
            Self::Plain => "spirv-cross with temporaries",
        }
    }
}

/// Why there is no picture by a way.
enum Failed {
    /// The way has a limit.
    Limit(&'static str),
    /// The emitted code is wrong, or what the way made of it.
    Fault(String),
}

/// A stage as GLSL.
struct Written<'e> {
    source: Source,
    /// The names of blocks, with the bindings and types of their variables. Where a text names the bindings itself, there are none.
    blocks: Vec<(String, SlotBinding, host::Layout<'e>)>,
    /// The names of textures, with their bindings. Where a text names the bindings itself, there are none.
    textures: Vec<(String, SlotBinding)>,
}

/// Whether the stages draw the picture of the program.
pub(super) fn same(drawn: &Drawn<'_>, stages: &[Emission]) -> Held {
    let Some(draw) = drawn.scene.draws.first() else { return Ok(()) };
    if stages.len() != draw.program.stages.len() {
        let has_geometry = draw.program.stage(Stage::Geometry).is_some();
        drawn.leave_out(if has_geometry { NO_GEOMETRY } else { "the target lacks something in a stage" });
        return Ok(());
    }
    // Of words, spirv-cross reads more than naga; naga's module of WGSL is at hand.
    let has_words = stages.iter().any(|stage| stage.words.is_some());
    let ways = if has_words { [Way::Cross, Way::Plain, Way::Naga] } else { [Way::Naga, Way::Cross, Way::Plain] };
    let (mut limits, mut faults) = (Vec::new(), Vec::new());
    for way in ways {
        match attempt(drawn, draw, stages, way) {
            Ok(()) => {
                drawn.compare(way.name());
                faults.into_iter().for_each(|(way, _)| drawn.leave_out(limits::of_way(way)));
                return Ok(());
            }
            Err(Failed::Limit(why)) => limits.push((way, why)),
            Err(Failed::Fault(message)) => faults.push((way, message)),
        }
    }
    match faults.into_iter().next() {
        Some((_, fault)) => Err(fault),
        None => {
            // What spirv-cross lacks is why the program is left out: it has fewer limits than naga.
            let why = limits.iter().find(|(way, _)| *way == Way::Cross).or(limits.last());
            why.into_iter().for_each(|(_, why)| drawn.leave_out(why));
            Ok(())
        }
    }
}

/// Whether the stages draw the picture of the program by one way.
fn attempt(drawn: &Drawn<'_>, draw: &Draw, stages: &[Emission], way: Way) -> Result<(), Failed> {
    let frame = Frame::of(drawn, draw);
    let written = stages.iter().map(|stage| match way {
        Way::Naga => naga::written(stage, frame),
        Way::Cross | Way::Plain => cross::written(stage, frame, way),
    });
    let written = written.collect::<Result<Vec<Written<'_>>, Failed>>()?;
    let sources: Vec<Source> = written.iter().map(|one| one.source.clone()).collect();
    let texts = || sources.iter().map(|source| format!("{}\n", source.text)).collect::<String>();
    let compilation = compiler().compile(&sources);
    let Some(program) = compilation.program else {
        let error = compilation.diagnostics.iter().find(|one| one.is_error());
        let message = error.map_or(String::new(), |one| format!("{}: {}", one.code.id, one.message));
        if let Some(why) = limits::of_refusal(way, &message) {
            return Err(Failed::Limit(why));
        }
        return Err(Failed::Fault(format!("GLSL of {} is not accepted: {message}\n{}", way.name(), texts())));
    };
    let other = host::with(draw, program, &written, frame.height);
    let mut scene = Scene { draws: vec![other], ..drawn.scene.clone() };
    // `gl_FragData` has an output for each that there may be.
    let last = scene.draws.iter().flat_map(|draw| &draw.program.interface.outputs).map(|one| one.location).max();
    scene.framebuffer.attachments = scene.framebuffer.attachments.max(last.map_or(1, |last| last + 1));
    let is_foreign = stages.iter().any(|stage| stage.origin == Origin::Glslang);
    compared(drawn, scene, is_foreign).map_err(|message| match limits::of_picture(way, &texts()) {
        Some(why) => Failed::Limit(why),
        None => Failed::Fault(format!("by {}: {message}\n{}", way.name(), texts())),
    })
}

/// The numbers that a text has, since the reference has no other place for them.
#[derive(Clone, Copy)]
struct Frame {
    /// The height of the picture.
    height: u32,
    /// The samples of a texel, in textures that have several.
    samples: usize,
}

impl Frame {
    fn of(drawn: &Drawn<'_>, draw: &Draw) -> Self {
        let several = draw.textures.iter().flatten().filter(|one| one.kind.dim == SamplerDim::Multisample);
        let samples = several.map(|one| one.levels.len()).max().unwrap_or(1);
        Self { height: drawn.scene.framebuffer.height, samples }
    }
}

/// A text for OpenGL. Emitted code has the origin above; here, what is turned is the place and the derivative. `textureSamples`, which
/// glisten does not have, becomes its value.
fn source(stage: Stage, text: &str, frame: Frame) -> Result<Source, Failed> {
    let name = match stage {
        Stage::Vertex => "a.vert",
        Stage::Fragment => "a.frag",
        Stage::Geometry => "a.geom",
    };
    let Frame { height, samples } = frame;
    let turned = format!("vec4(gl_FragCoord.x, {height}.0 - gl_FragCoord.y, gl_FragCoord.zw)");
    let text = replaced(&replaced(text, "gl_FragCoord", &turned), "dFdy", "-dFdy");
    let text = text.replace("#extension GL_ARB_shader_texture_image_samples : require\n", "");
    let mut parts = text.split("textureSamples(");
    let first = parts.next().unwrap_or_default().to_owned();
    let text = parts.fold(first, |mut made, part| {
        // Its argument is a name.
        let (_, rest) = part.split_once(')').unwrap_or(("", part));
        made.push_str(&format!("{samples}{rest}"));
        made
    });
    Ok(Source { name: name.to_owned(), text: text.into(), stage })
}

/// A text with another one where a name begins. Two signs in a row stay two.
fn replaced(text: &str, name: &str, other: &str) -> String {
    let mut parts = text.split(name);
    let mut made = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let is_inner = made.ends_with(|letter: char| letter.is_ascii_alphanumeric() || letter == '_');
        if made.ends_with('-') {
            made.push(' ');
        }
        made.push_str(if is_inner { name } else { other });
        made.push_str(part);
    }
    made
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

/// The same bits, or numbers inside of the envelope. Where constants are evaluated by somebody else, numbers may be close, too.
fn compared(drawn: &Drawn<'_>, scene: Scene, is_foreign: bool) -> Held {
    let attachments = drawn.scene.framebuffer.attachments as usize;
    let picture = picture_of(&scene, Precision::F32, attachments)?;
    if drawn.single.difference(&Bits::of(&picture)).is_ok() || drawn.is_inside(&picture)? {
        return Ok(());
    }
    if is_foreign && is_close(&drawn.picture, &picture) {
        return Ok(());
    }
    inside(drawn, &Other { scene: &scene, attachments })
}

/// Whether all numbers of two pictures are close.
fn is_close(one: &Picture, other: &Picture) -> bool {
    let numbers = |picture: &Picture| picture.attachments.iter().flatten().flatten().copied().collect::<Vec<f64>>();
    let (one, other) = (numbers(one), numbers(other));
    let close = |(a, b): (&f64, &f64)| a.is_nan() || a == b || (a - b).abs() <= CLOSE * a.abs().max(1.0);
    one.len() == other.len() && one.iter().zip(&other).all(close)
}

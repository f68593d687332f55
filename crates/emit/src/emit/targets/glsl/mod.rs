//! GLSL for OpenGL 3.3, OpenGL 4.5, WebGL 2 and Vulkan, from the typed program and not from naga's module: the language is the
//! same, so everything keeps its name, its place and its comments.
//!
//! *In:* a linked program, a stage, a version. *Out:* the text, or what the version lacks.
//!
//! *Holds:* but for Vulkan, the conventions are OpenGL's own, whatever [`Conventions`] say: nothing is flipped, and
//! clip-space z is unchanged. Locations of attributes and outputs are in the text; varyings, uniforms and blocks match
//! by name.
//!
//! | file | contents |
//! | --- | --- |
//! | `limits` | what WebGL 2 lacks |
//! | `blocks` | blocks between stages as varyings, for WebGL 2 |
//! | `commas` | commas of constant expressions |
//! | `rewrite` | what later versions have dropped, in terms of what they have |
//! | `names` | names that are words of the version |
//! | `varyings` | one name for both ends of a varying that matches by location |
//! | `vulkan` | what Vulkan's rules want: locations, sets, bindings, its coordinates |

mod blocks;
mod commas;
mod limits;
mod names;
mod rewrite;
mod varyings;
mod vulkan;

pub(in crate::emit) use names::renamed;

use super::super::emitted::Emitted;
use crate::select::{Choice, select};
use crate::target::{Conventions, GlslVersion};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::general;
use glisten_front::hir::{Function, Global, GlobalId, Notes, Shader, Stage, Storage, Type, TypeId, Types, print_with};
use glisten_front::language::{Profile, Version};
use glisten_front::link::Program;
use glisten_front::source::{SourceMap, Span, comments};
use std::collections::BTreeSet;

/// Writes a stage as GLSL.
pub(in crate::emit) fn write(
    program: &Program,
    stage: Stage,
    conventions: &Conventions,
    sources: Option<&SourceMap>,
) -> Result<Emitted, Vec<Diagnostic>> {
    let Some(shader) = program.stage(stage) else {
        let message = format!("the program `{}` has no {} stage", program.name, stage.name());
        return Err(vec![Diagnostic::new(&general::INTERNAL, Span::default(), message)]);
    };
    let version = conventions.glsl_version;
    let lacks = match version {
        GlslVersion::Es300 => limits::of_es(program, shader),
        GlslVersion::Desktop330 => limits::of_330(&program.types, shader),
        GlslVersion::Desktop450 | GlslVersion::Vulkan => Vec::new(),
    };
    if !lacks.is_empty() {
        return Err(lacks);
    }
    let (mut types, mut shader) = in_terms_of(program, shader, version).map_err(|diagnostic| vec![*diagnostic])?;
    let layouts = match version {
        GlslVersion::Vulkan => vulkan::rewrite(&mut types, &mut shader, program, conventions)?,
        GlslVersion::Desktop330 | GlslVersion::Desktop450 | GlslVersion::Es300 => vulkan::Layouts::default(),
    };
    names::apply(&mut types, &mut shader, program, version);
    let keeps_all = matches!(version, GlslVersion::Desktop330 | GlslVersion::Desktop450);
    let notes = Comments { sources, keeps_all, layouts };
    let text = print_with(&types, &shader, Some(&notes));
    Ok(Emitted::Text(with_precisions(text, &types, &shader, &notes)))
}

/// A stage in terms of what a version has, under the names of the source.
fn in_terms_of(program: &Program, shader: &Shader, version: GlslVersion) -> Result<(Types, Shader), Box<Diagnostic>> {
    let mut types = program.types.clone();
    let mut shader = match version {
        GlslVersion::Desktop450 | GlslVersion::Vulkan => shader.clone(),
        // Before 4.00, samplers and blocks take constant indices (3.30 §4.1.7, §4.3.7).
        GlslVersion::Desktop330 | GlslVersion::Es300 => select(&types, shader, Choice::Structs)?.into_owned(),
    };
    shader.version = language(version, shader.version.span);
    rewrite::rewrite(&mut types, &mut shader, program, version);
    Ok((types, shader))
}

fn language(version: GlslVersion, span: Span) -> Version {
    let (number, profile) = match version {
        GlslVersion::Desktop330 => (330, Profile::Core),
        GlslVersion::Desktop450 | GlslVersion::Vulkan => (450, Profile::Core),
        GlslVersion::Es300 => (300, Profile::Es),
    };
    Version { number, profile, span }
}

/// The comments of the source. ES and Vulkan get only what is in use, since the rest may use what they lack.
struct Comments<'a> {
    sources: Option<&'a SourceMap>,
    keeps_all: bool,
    layouts: vulkan::Layouts,
}

impl Notes for Comments<'_> {
    fn keeps_global(&self, global: &Global) -> bool {
        let own = matches!(global.storage, Storage::Uniform | Storage::Private | Storage::Const);
        self.keeps_all || global.used || !own || global.block.is_some()
    }

    fn keeps_function(&self, function: &Function) -> bool {
        self.keeps_all || function.reachable
    }

    fn layout(&self, global: GlobalId) -> Vec<String> {
        self.layouts.of(global)
    }

    fn builtin_name(&self, builtin: BuiltinVariable) -> &'static str {
        self.layouts.builtin_name(builtin)
    }

    fn above(&self, span: Span) -> Vec<String> {
        self.sources.map_or_else(Vec::new, |sources| comments::above_but_not_leading(sources, span))
    }

    fn behind(&self, span: Span) -> Option<String> {
        comments::behind(self.sources?, span)
    }
}

/// The text with the precision statements that GLSL ES 3.00 §4.5.4 requires: everything has the highest precision, as
/// in OpenGL.
fn with_precisions(text: String, types: &Types, shader: &Shader, notes: &Comments<'_>) -> String {
    if shader.version.profile != Profile::Es {
        return text;
    }
    let mut samplers = BTreeSet::new();
    let globals = shader.globals.iter().filter(|global| notes.keeps_global(global)).map(|global| global.ty);
    let functions = shader.functions.iter().filter(|function| notes.keeps_function(function));
    let locals = functions.flat_map(|function| function.params().iter().map(|param| param.ty));
    for ty in globals.chain(locals) {
        sampler_types(types, ty, &mut samplers);
    }
    let words = ["float".to_owned(), "int".to_owned()].into_iter().chain(samplers);
    let lines: String = words.map(|ty| format!("precision highp {ty};\n")).collect();
    match text.split_once('\n') {
        Some((first, rest)) => format!("{first}\n{lines}{rest}"),
        None => text,
    }
}

fn sampler_types(types: &Types, ty: TypeId, found: &mut BTreeSet<String>) {
    match types.get(ty) {
        Type::Sampler(sampler) => {
            found.insert(sampler.name());
        }
        Type::Array(element, _) => sampler_types(types, element, found),
        Type::Struct(id) => {
            types.structure(id).members.iter().for_each(|member| sampler_types(types, member.ty, found));
        }
        _ => {}
    }
}

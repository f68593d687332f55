//! The comments next to declarations: above functions, structs and variables; next to members and uniforms.
//!
//! *In:* the stages that a module comes from, and their texts. *Out:* [`Notes`], by the names of the source.

use super::body_comments;
use super::comments::of_wgsl;
use super::tree::Body;
use glisten_front::hir::{Shader, Stage, Storage, Type, Types};
use glisten_front::source::{SourceMap, Span, comments};
use rustc_hash::FxHashMap;

/// A comment above something, and one behind it.
#[derive(Debug, Default)]
pub(super) struct Note {
    pub(super) above: Vec<String>,
    pub(super) behind: Option<String>,
}

/// The comments of a module's source.
#[derive(Default)]
pub(in crate::emit) struct Notes<'s> {
    sources: Option<&'s SourceMap>,
    mains: Vec<(Stage, Span)>,
    functions: FxHashMap<u32, Note>,
    structs: FxHashMap<String, Note>,
    /// Members by struct and name.
    members: FxHashMap<(String, String), Note>,
    variables: FxHashMap<String, Note>,
    /// Inputs by stage.
    inputs: FxHashMap<(Stage, String), Note>,
}

impl<'s> Notes<'s> {
    /// The comments of these stages.
    pub(in crate::emit) fn of(types: &Types, shaders: &[&Shader], sources: Option<&'s SourceMap>) -> Self {
        let mut notes = Self { sources, ..Self::default() };
        for shader in shaders {
            let main = shader.main.map(|main| shader.function(main).span);
            notes.mains.extend(main.map(|main| (shader.stage, main)));
        }
        let Some(sources) = sources else { return notes };
        for shader in shaders {
            notes.add_shader(shader, sources);
        }
        notes.add_structs(types, sources);
        notes
    }

    fn add_shader(&mut self, shader: &Shader, sources: &SourceMap) {
        for function in &shader.functions {
            if let Some(note) = note(sources, function.span, false) {
                self.functions.entry(function.span.start).or_insert(note);
            }
        }
        for global in shader.globals.iter().filter(|global| global.builtin.is_none()) {
            match &global.block {
                Some(block) => {
                    if let Some(note) = note(sources, global.span, false) {
                        self.structs.entry(block.name.clone()).or_insert(note);
                    }
                }
                None => {
                    let declares =
                        matches!(global.storage, Storage::Uniform | Storage::Private | Storage::Const | Storage::In);
                    let Some(note) = note(sources, global.span, declares) else { continue };
                    if global.storage == Storage::In {
                        self.inputs.entry((shader.stage, global.name.clone())).or_insert(note);
                    } else {
                        self.variables.entry(global.name.clone()).or_insert(note);
                    }
                }
            }
        }
    }

    fn add_structs(&mut self, types: &Types, sources: &SourceMap) {
        for id in types.ids() {
            let Type::Struct(id) = types.get(id) else { continue };
            let structure = types.structure(id);
            if !structure.is_block
                && let Some(note) = note(sources, structure.span, false)
            {
                self.structs.entry(structure.name.clone()).or_insert(note);
            }
            for member in &structure.members {
                if let Some(note) = note(sources, member.span, true) {
                    self.members.entry((structure.name.clone(), member.name.clone())).or_insert(note);
                }
            }
        }
    }

    pub(super) fn above_struct(&self, name: &str) -> &[String] {
        self.structs.get(name).map_or(&[], |note| note.above.as_slice())
    }

    /// The comments of a member. Loose uniforms are members of one struct, which the source does not have.
    pub(super) fn of_member(&self, structure: &str, member: &str) -> Option<&Note> {
        let own = self.members.get(&(structure.to_owned(), member.to_owned()));
        own.or_else(|| self.variables.get(member).filter(|_| structure == "Uniforms"))
    }

    pub(super) fn of_variable(&self, name: &str) -> Option<&Note> {
        self.variables.get(name)
    }

    /// The comments of an input.
    pub(super) fn of_input(&self, stage: naga::ShaderStage, name: &str) -> Option<&Note> {
        self.inputs.get(&(stage_of(stage), name.to_owned()))
    }

    /// The comments above a function; those of generated ones are not there.
    pub(super) fn above_function(&self, is_named: bool, span: naga::Span) -> &[String] {
        let start = span.to_range().map_or(0, |range| range.start as u32);
        let note = self.functions.get(&start).filter(|_| is_named && span.is_defined());
        note.map_or(&[], |note| note.above.as_slice())
    }

    /// Where the source has the entry point of a stage.
    pub(super) fn main(&self, stage: naga::ShaderStage) -> naga::Span {
        let stage = stage_of(stage);
        let main = self.mains.iter().find(|(of, _)| *of == stage);
        main.map_or(naga::Span::UNDEFINED, |(_, span)| naga::Span::new(span.start, span.end))
    }

    /// Puts the comments inside of a function into its tree.
    pub(super) fn comment_body(&self, body: &mut Body<'_>, function: naga::Span) {
        if let (Some(sources), Some(range)) = (self.sources, function.to_range()) {
            body_comments::add(body, sources, Span::new(range.start as u32, range.end as u32));
        }
    }
}

fn stage_of(stage: naga::ShaderStage) -> Stage {
    if stage == naga::ShaderStage::Vertex { Stage::Vertex } else { Stage::Fragment }
}

fn note(sources: &SourceMap, span: Span, behind: bool) -> Option<Note> {
    let above = of_wgsl(&comments::above_but_not_leading(sources, span));
    let behind = behind.then(|| comments::behind(sources, span)).flatten();
    let behind = behind.map(|behind| of_wgsl(&[behind]).concat().trim_end().to_owned());
    (!above.is_empty() || behind.is_some()).then_some(Note { above, behind })
}

//! `webgpu-limits`: more varyings, textures, blocks or colors than WebGPU promises on every machine.

use super::super::{Findings, Subject};
use crate::hir::{GlobalId, Shader, Stage};
use crate::source::Span;

/// The limits that every WebGPU has (WebGPU §3.6.2).
const VARYINGS: u32 = 16;
const TEXTURES: usize = 16;
const BLOCKS: usize = 12;
const COLORS: u32 = 8;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let (program, interface) = (subject.program, &subject.program.interface);
    let mut tell = |span: Span, count: u64, what: &str, limit: u64| {
        let message = format!("{count} {what}, and WebGPU promises {limit}");
        findings.push(findings.at(span, message));
    };
    if let Some(fragment) = program.stage(Stage::Fragment) {
        let last = interface.varyings.iter().max_by_key(|varying| varying.location);
        if let Some((last, to)) =
            last.and_then(|last| Some((last, last.to?))).filter(|(last, _)| last.location >= VARYINGS)
        {
            tell(place(fragment, to.global), u64::from(last.location) + 1, "locations of varyings", VARYINGS.into());
        }
        let last = interface.outputs.iter().max_by_key(|output| output.location);
        if let Some(last) = last.filter(|last| last.location >= COLORS) {
            tell(place(fragment, last.global), u64::from(last.location) + 1, "colors", COLORS.into());
        }
    }
    for shader in &program.stages {
        let in_stage = |globals: &[(Stage, GlobalId)]| {
            let found = globals.iter().find(|(stage, id)| *stage == shader.stage && shader.global(*id).used);
            found.map(|(_, id)| *id)
        };
        let textures: Vec<GlobalId> = interface.samplers.iter().filter_map(|slot| in_stage(&slot.globals)).collect();
        if let Some(last) = textures.last().filter(|_| textures.len() > TEXTURES) {
            tell(place(shader, *last), textures.len() as u64, "textures in one stage", TEXTURES as u64);
        }
        let blocks = interface.blocks.iter().filter_map(|block| {
            let root = interface.roots.get(block.root.0 as usize)?;
            Some((block, in_stage(&root.globals)?))
        });
        let blocks: Vec<_> = blocks.collect();
        let count: usize = blocks.iter().map(|(block, _)| block.array_size.unwrap_or(1) as usize).sum();
        if let Some((_, last)) = blocks.last().filter(|_| count > BLOCKS) {
            tell(place(shader, *last), count as u64, "uniform blocks in one stage", BLOCKS as u64);
        }
    }
}

fn place(shader: &Shader, id: GlobalId) -> Span {
    let span = shader.global(id).span;
    if span.is_known() { span } else { shader.anchor() }
}

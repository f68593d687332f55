//! Checks the interfaces of a program that already has errors.
//!
//! *In:* analyzed shaders without their uncertain declarations. *Out:* diagnostics about declarations that differ
//! between stages.
//!
//! *Holds:* a stage with errors may declare more than is known. So missing declarations are not reported, and limits
//! are not checked.

use super::canonical::{self, Sizes};
use super::{Bindings, Linker, matching, stages, uniforms};
use crate::diagnostic::Diagnostics;
use crate::hir::{Shader, Stage, Types};

/// A shader without its uncertain declarations.
#[derive(Clone, Debug)]
pub struct Understood {
    /// The shader.
    pub shader: Shader,
    /// Whether it has no errors.
    pub is_complete: bool,
}

/// Checks the declarations of all stages against each other.
pub fn check_understood(mut types: Types, shaders: Vec<Understood>, diagnostics: &mut Diagnostics) {
    let complete: Vec<bool> = shaders.iter().map(|shader| shader.is_complete).collect();
    let mut shaders: Vec<Shader> = shaders.into_iter().map(|shader| shader.shader).collect();
    canonical::unify(&mut types, &mut shaders, Sizes::Tentative);
    let mut rest: Vec<(Shader, bool)> = shaders.into_iter().zip(complete).collect();
    let (mut found, mut joined, mut is_complete) = (Vec::new(), Vec::new(), Vec::new());
    for stage in Stage::ALL {
        let (members, others): (Vec<_>, Vec<_>) = rest.into_iter().partition(|(shader, _)| shader.stage == stage);
        rest = others;
        let all = members.iter().all(|(_, complete)| *complete);
        let members: Vec<Shader> = members.into_iter().map(|(shader, _)| shader).collect();
        // Merging shaders of one stage would report that the others lack declarations of the one with errors.
        joined.extend(if all { stages::in_order(&mut types, members, &mut found) } else { members });
        is_complete.resize(joined.len(), all);
    }
    canonical::unify(&mut types, &mut joined, Sizes::Final);
    let mut ctx = Linker { types: &types, bindings: Bindings::default(), diagnostics, failed: false };
    found.into_iter().for_each(|diagnostic| ctx.report(diagnostic));
    check_neighbors(&mut ctx, &joined, &is_complete);
    uniforms::check(&mut ctx, &joined);
}

/// Checks each shader against those of the next existing stage.
fn check_neighbors(ctx: &mut Linker<'_>, shaders: &[Shader], is_complete: &[bool]) {
    for (producer, complete) in shaders.iter().zip(is_complete) {
        let later = shaders.iter().filter(|shader| shader.stage > producer.stage);
        let Some(next) = later.clone().map(|shader| shader.stage).min() else { continue };
        for consumer in later.filter(|shader| shader.stage == next) {
            matching::check_variables(ctx, producer, consumer, *complete);
        }
    }
}

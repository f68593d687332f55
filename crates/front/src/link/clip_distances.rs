//! Passes `gl_ClipDistance` to the fragment stage (GLSL 1.50 §7.2).
//!
//! *In:* the stages before and after the rasterizer. *Out:* a varying for each element that the fragment stage reads.
//! No target passes the built-in variable to that stage, so it takes locations as other varyings do.

use super::{Varying, VaryingEnd};
use crate::builtin::BuiltinVariable;
use crate::diagnostic::{Diagnostic, codes, plural};
use crate::hir::{GlobalId, Interpolation, Sampling, Shader, TypeId, Types};

/// The clip distances that a fragment stage reads.
#[derive(Clone, Copy)]
pub(super) struct ClipDistances<'a> {
    fragment: &'a Shader,
    reader: GlobalId,
    len: u32,
    writer: Option<(GlobalId, u32)>,
}

impl<'a> ClipDistances<'a> {
    /// Returns `None` if the fragment stage reads none.
    pub(super) fn find(types: &Types, producer: Option<&Shader>, fragment: Option<&'a Shader>) -> Option<Self> {
        let (fragment, (reader, len)) = (fragment?, used(types, fragment?)?);
        let writer = producer.and_then(|producer| used(types, producer));
        Some(Self { fragment, reader, len, writer })
    }

    /// The number of scalars.
    pub(super) fn components(&self) -> u32 {
        self.len
    }

    /// The number of locations, with four scalars in each.
    pub(super) fn locations(&self) -> u32 {
        self.len.div_ceil(4)
    }

    /// The varyings, from location `first` on.
    pub(super) fn at(&self, first: u32) -> Vec<Varying> {
        let end = |global: GlobalId, index: u32| VaryingEnd { global, flat_offset: index };
        let varying = |index: u32| Varying {
            name: format!("gl_ClipDistance[{index}]"),
            ty: TypeId::FLOAT,
            location: first + index / 4,
            component: index % 4,
            interpolation: Interpolation::Smooth,
            sampling: Sampling::Center,
            active: true,
            from: self.writer.filter(|&(_, written)| index < written).map(|(global, _)| end(global, index)),
            to: Some(end(self.reader, index)),
        };
        (0..self.len).map(varying).collect()
    }

    /// The diagnostic if they do not fit.
    pub(super) fn no_room(&self, limit: u32) -> Diagnostic {
        let (taken, all) = (plural(self.locations(), "location"), plural(limit, "location"));
        let message = format!("no room for `gl_ClipDistance`, which takes {taken}: there are {all}");
        let declared = self.fragment.global(self.reader).span;
        let span = super::usage::first_use(self.fragment, self.reader).unwrap_or(declared);
        Diagnostic::new(&codes::link::TOO_MANY_VARYINGS, span, message)
            .here("the fragment stage reads it, so that it is interpolated as a varying is")
    }
}

/// `gl_ClipDistance` of a stage that uses it, and its length.
fn used(types: &Types, shader: &Shader) -> Option<(GlobalId, u32)> {
    let mut globals = shader.globals();
    let (id, global) = globals.find(|(_, global)| global.builtin == Some(BuiltinVariable::ClipDistance))?;
    global.used.then_some((id, types.flat_len(global.ty)))
}

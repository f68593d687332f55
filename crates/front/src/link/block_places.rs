//! Checks the offsets that members of uniform blocks ask for (GLSL 4.40 §4.4.5).
//!
//! *In:* the type of a block. *Out:* diagnostics. *Holds:* an offset is a multiple of the base alignment of its member, and
//! members do not overlap; their order is that of their offsets.

use super::Linker;
use super::layout::{extent, struct_members};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::qualifiers::LAYOUT_VALUE;
use crate::hir::{MatrixLayout, StructId};

/// Reports the offsets of a block's members that are not possible.
pub(super) fn check(ctx: &mut Linker<'_>, id: StructId) {
    let types = ctx.types;
    let mut end = 0;
    let placed = struct_members(types, id, MatrixLayout::ColumnMajor);
    for (member, place) in types.structure(id).members.iter().zip(placed) {
        let align = extent(types, member.ty, place.layout).align;
        let problem = match member.place.offset {
            Some(offset) if offset % align != 0 => Some((
                format!("the offset {offset} is not a multiple of {align}"),
                "the alignment of its type in bytes",
            )),
            Some(offset) if offset < end => Some((
                format!("the offset {offset} lies in the member before, which ends at {end}"),
                "offsets grow from member to member",
            )),
            _ => None,
        };
        if let Some((message, here)) = problem {
            ctx.report(Diagnostic::new(&LAYOUT_VALUE, member.span, message).here(here));
            return;
        }
        end = place.end;
    }
}

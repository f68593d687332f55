//! `std140-padding`: an array in a uniform block whose elements take more room than they have.

use super::super::{Findings, Subject};
use crate::hir::{BlockLayout, Scalar, Storage, Type};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let types = &subject.program.types;
    for shader in &subject.program.stages {
        let blocks = shader.globals.iter().filter(|global| {
            let layout = global.block.as_ref().map(|block| block.layout);
            global.storage == Storage::Uniform && layout == Some(BlockLayout::Std140)
        });
        for block in blocks {
            let element = types.element(block.ty).unwrap_or(block.ty);
            let Type::Struct(id) = types.get(element) else { continue };
            let padded = types.structure(id).members.iter().find_map(|member| {
                let Type::Array(element, _) = types.get(member.ty) else { return None };
                match types.get(element) {
                    Type::Scalar(_) => Some((member, element, 4)),
                    Type::Vector(scalar, size @ (2 | 3)) if scalar != Scalar::Bool => {
                        Some((member, element, 4 * u32::from(size)))
                    }
                    _ => None,
                }
            });
            if let Some((member, element, bytes)) = padded {
                let name = types.name(element);
                let message = format!("each `{name}` of `{}` takes 16 bytes in the block, not {bytes}", member.name);
                let finding = findings.at(member.span, message);
                findings.push(finding.help("use an array of `vec4`, or give the host's array the same stride"));
            }
        }
    }
}

//! Names of `dynamic`: which uniforms and samplers of a program they mean.
//!
//! *In:* a name and the interface of a program. *Out:* whether the name means a uniform or a sampler of it. *Holds:* a name
//! that is an element of an array of numbers means the whole array, of which no part can be fixed alone. State of the fixed-function
//! pipeline means what is derived from it, too.

use crate::fixed::{FixedFunction, uses_fixed_state};
use glisten_front::link::{Interface, Program, UniformLeaf};

/// Whether a name means this uniform: it is the uniform, a struct or block that it is part of, or an element of it.
pub fn names_uniform(interface: &Interface, name: &str, leaf: &UniformLeaf) -> bool {
    let of_root = || interface.roots.get(leaf.root.0 as usize).is_some_and(|root| root.name == name);
    is_or_holds(name, &leaf.name) || names_element(name, leaf) || of_root() || follows(interface, name, leaf)
}

/// Whether a uniform follows from state of the fixed-function pipeline that a name means.
fn follows(interface: &Interface, name: &str, leaf: &UniformLeaf) -> bool {
    let Some(root) = interface.roots.get(leaf.root.0 as usize).filter(|root| root.block.is_none()) else {
        return false;
    };
    if !name.starts_with(OWN) || !root.name.starts_with(OWN) {
        return false;
    }
    let Some(values) = FixedFunction::follow(name, &root.name) else { return false };
    let starts =
        interface.uniforms.iter().filter(|other| other.root == leaf.root).map(|other| other.flat_offset as usize);
    let start = leaf.flat_offset as usize;
    let end = starts.filter(|other| *other > start).min().unwrap_or(values.len());
    values.get(start..end).is_some_and(|own| own.contains(&true))
}

/// The beginning of names that the language has for itself (GLSL 1.20 §3.7).
const OWN: &str = "gl_";

/// Whether a program may have a name in `dynamic`: it means anything of it, or is state of the fixed-function pipeline, which it reads.
pub fn is_known(program: &Program, name: &str) -> bool {
    let is_state = || FixedFunction::has(name) && uses_fixed_state(program);
    names_anything(&program.interface, name) || is_state()
}

/// Whether a name is an element of an array of numbers.
pub fn names_element(name: &str, leaf: &UniformLeaf) -> bool {
    let index = name.strip_prefix(leaf.name.as_str()).and_then(|rest| rest.strip_prefix('[')?.strip_suffix(']'));
    let index = index.and_then(|index| index.parse::<u32>().ok());
    leaf.array_size.is_some_and(|size| index.is_some_and(|index| index < size))
}

/// Whether a name means this sampler.
pub fn names_sampler(name: &str, sampler: &str) -> bool {
    is_or_holds(name, sampler)
}

/// Whether a name means anything of a program.
pub fn names_anything(interface: &Interface, name: &str) -> bool {
    interface.uniforms.iter().any(|leaf| names_uniform(interface, name, leaf))
        || interface.samplers.iter().any(|slot| names_sampler(name, &slot.name))
}

fn is_or_holds(name: &str, leaf: &str) -> bool {
    let name = name.strip_suffix("[0]").filter(|base| *base == leaf).unwrap_or(name);
    leaf.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

//! Modules of other translators, which a draw runs in place of the emitted ones.
//!
//! ```text
//!  bytes ──► read        limits, then naga's front end for WGSL or SPIR-V, then spirv-val ──► Foreign
//!              blocks    locations of the members of blocks, which naga reads
//!        ──► interface   locations, types, interpolation, bindings, block offsets, of this and of the emitted module
//!        ──► differs     which part of the interface is another one
//! ```
//!
//! *In:* the bytes of a `.wgsl` or `.spv` file, and the stage that it is for. *Out:* [`Foreign`] modules for
//! [`Gpu::prepare_foreign`](crate::Gpu::prepare_foreign), or the reason why a module cannot be judged.
//!
//! *Holds:* whatever the bytes are, nothing panics and nothing runs away. SPIR-V reaches the driver only if `spirv-val`
//! accepts it. That is all that can be checked: a valid module may still do what Vulkan leaves undefined, such as reading
//! beyond an array. WGSL has no such parts.

mod blocks;
mod differs;
mod interface;
mod read;
mod spirv;

use crate::{Error, Via};
use glisten_emit::Emitted;
use glisten_front::hir::Stage;
use interface::Interface;
use std::collections::BTreeSet;

/// A module of another translator.
#[derive(Clone, Debug)]
pub struct Foreign {
    /// The draw whose stage it replaces, counted from 0; `None` for all draws.
    pub draw: Option<usize>,
    /// The stage.
    pub stage: Stage,
    /// The name of the file.
    pub name: String,
    code: Emitted,
    interface: Interface,
}

impl Foreign {
    /// Reads a module for a stage of one draw, or of all.
    ///
    /// # Errors
    /// [`Error::Foreign`] if it is no such module or cannot be checked, [`Error::Lacks`] if this machine has nothing to
    /// check it with.
    pub fn read(draw: Option<usize>, stage: Stage, name: &str, bytes: &[u8], via: Via) -> Result<Self, Error> {
        let told = |why: String| Error::Foreign(format!("`{name}`: {why}"));
        let (code, module) = read::read(bytes, stage, via).map_err(told)?;
        if let Emitted::Words(words) = &code {
            spirv::validate(name, words)?;
        }
        let interface = Interface::of(&module, stage).map_err(told)?;
        Ok(Self { draw, stage, name: name.to_owned(), code, interface })
    }

    /// The form in which it runs.
    pub fn via(&self) -> Via {
        match self.code {
            Emitted::Text(_) => Via::Wgsl,
            Emitted::Words(_) => Via::Spirv,
        }
    }

    /// The locations of the inputs that the module declares.
    pub(crate) fn read_by_it(&self) -> BTreeSet<u32> {
        self.interface.inputs.keys().copied().collect()
    }

    /// The locations of the inputs of an emitted fragment stage, of which there may be several forms.
    pub(crate) fn inputs_of(emitted: impl IntoIterator<Item = Emitted>) -> Option<BTreeSet<u32>> {
        let interface = emitted_interface(Stage::Fragment, emitted).ok()?;
        Some(interface.inputs.keys().copied().collect())
    }

    /// Whether the module lacks an output of the emitted one.
    pub(crate) fn leaves_out(&self, emitted: impl IntoIterator<Item = Emitted>) -> bool {
        emitted_interface(self.stage, emitted).is_ok_and(|expected| {
            expected.outputs.keys().any(|location| !self.interface.outputs.contains_key(location))
        })
    }

    /// The code, if its interface is that of the emitted module, of which there may be several forms: the first that
    /// can be read back counts. Of the outputs, only those in `read` must be there, if that is known.
    pub(crate) fn code_instead_of(
        &self,
        program: &str,
        emitted: impl IntoIterator<Item = Emitted>,
        read: Option<BTreeSet<u32>>,
    ) -> Result<Emitted, Error> {
        let told = |why: String| Error::Foreign(format!("`{}`: {why}", self.name));
        let mut expected = emitted_interface(self.stage, emitted).map_err(told)?;
        if let Some(read) = read {
            let is_there = |location: &u32| read.contains(location) || self.interface.outputs.contains_key(location);
            expected.outputs.retain(|location, _| is_there(location));
        }
        let differences = differs::differences(&self.interface, &expected, self.stage);
        if differences.is_empty() {
            return Ok(self.code.clone());
        }
        let stage = self.stage.name();
        Err(Error::Foreign(format!(
            "`{}`: its interface is not that of the {stage} stage of `{program}`: {}\nhelp: `glisten reflect` and `glisten compile` show \
             the interface that a module must have",
            self.name,
            differences.join("; ")
        )))
    }
}

/// The interface of an emitted module: of the first form that can be read back.
fn emitted_interface(stage: Stage, emitted: impl IntoIterator<Item = Emitted>) -> Result<Interface, String> {
    let module = emitted.into_iter().find_map(|code| read::parse(&code).ok());
    let module = module.ok_or_else(|| "the emitted module cannot be read back to compare them".to_owned())?;
    Interface::of(&module, stage)
}

#[cfg(test)]
mod tests;

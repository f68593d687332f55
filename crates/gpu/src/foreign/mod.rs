//! Modules of other translators, which a draw runs in place of the emitted ones.
//!
//! ```text
//!  bytes ──► read        limits, then naga's front end for WGSL or SPIR-V, then spirv-val ──► Foreign
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

mod differs;
mod interface;
mod read;
mod spirv;

use crate::{Error, Via};
use glisten_emit::Emitted;
use glisten_front::hir::Stage;
use interface::Interface;

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

    /// The code, if its interface is that of the emitted module, of which there may be several forms: the first that
    /// can be read back counts.
    pub(crate) fn code_instead_of(
        &self,
        program: &str,
        emitted: impl IntoIterator<Item = Emitted>,
    ) -> Result<Emitted, Error> {
        let told = |why: String| Error::Foreign(format!("`{}`: {why}", self.name));
        let module = emitted.into_iter().find_map(|code| read::parse(&code).ok());
        let module = module.ok_or_else(|| told("the emitted module cannot be read back to compare them".to_owned()))?;
        let expected = Interface::of(&module, self.stage).map_err(told)?;
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

#[cfg(test)]
mod tests;

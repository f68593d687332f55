//! [`Left`]: what is left of a program, by which an account is made.
//!
//! *In:* the stages that are left, and their interface. *Out:* names.

use glisten_front::hir::Shader;
use glisten_front::link::Interface;
use std::collections::BTreeSet;

/// What is left of a program: its stages, whose spans are the original's, and the names of its interface.
pub(crate) struct Left<'a> {
    pub(crate) shaders: &'a [Shader],
    pub(crate) attributes: BTreeSet<&'a str>,
    pub(crate) varyings: BTreeSet<&'a str>,
    pub(crate) outputs: BTreeSet<&'a str>,
    pub(crate) blocks: BTreeSet<&'a str>,
    pub(crate) uniforms: BTreeSet<&'a str>,
    pub(crate) samplers: BTreeSet<&'a str>,
}

impl<'a> Left<'a> {
    /// All that an interface has.
    pub(crate) fn all(shaders: &'a [Shader], interface: &'a Interface) -> Self {
        Self::filtered(shaders, interface, |_| true)
    }

    /// What is active of an interface.
    pub(crate) fn active(shaders: &'a [Shader], interface: &'a Interface) -> Self {
        Self::filtered(shaders, interface, |active| active)
    }

    fn filtered(shaders: &'a [Shader], interface: &'a Interface, keeps: fn(bool) -> bool) -> Self {
        fn names<'n>(rows: impl Iterator<Item = (&'n String, bool)>, keeps: fn(bool) -> bool) -> BTreeSet<&'n str> {
            rows.filter(|(_, active)| keeps(*active)).map(|(name, _)| name.as_str()).collect()
        }
        Self {
            shaders,
            attributes: names(interface.attributes.iter().map(|row| (&row.name, row.active)), keeps),
            varyings: names(interface.varyings.iter().map(|row| (&row.name, row.active)), keeps),
            outputs: interface.outputs.iter().map(|row| row.name.as_str()).collect(),
            blocks: names(interface.blocks.iter().map(|row| (&row.name, row.active)), keeps),
            uniforms: names(interface.uniforms.iter().map(|row| (&row.name, row.active)), keeps),
            samplers: names(interface.samplers.iter().map(|row| (&row.name, row.active)), keeps),
        }
    }
}

//! The names that an upgrade replaces, as tables.
//!
//! *In:* an old name. *Out:* the name of today. *Holds:* the names of the fixed-function pipeline come from the table of the
//! front end.

use std::collections::BTreeSet;

/// Lookups in textures: the old names without what says the dimension, and the new ones. An old name is `texture` or `shadow`,
/// one of [`DIMENSIONS`], and one of these endings (end of GLSL 1.50 §8.7, ARB_shader_texture_lod, EXT_shader_texture_lod,
/// EXT_gpu_shader4, EXT_texture_array).
static ENDINGS: &[(&str, &str)] = &[
    ("", ""),
    ("Proj", "Proj"),
    ("Lod", "Lod"),
    ("ProjLod", "ProjLod"),
    ("LodEXT", "Lod"),
    ("ProjLodEXT", "ProjLod"),
    ("Grad", "Grad"),
    ("ProjGrad", "ProjGrad"),
    ("GradARB", "Grad"),
    ("ProjGradARB", "ProjGrad"),
    ("GradEXT", "Grad"),
    ("ProjGradEXT", "ProjGrad"),
    ("Offset", "Offset"),
    ("ProjOffset", "ProjOffset"),
    ("LodOffset", "LodOffset"),
    ("ProjLodOffset", "ProjLodOffset"),
    ("GradOffset", "GradOffset"),
    ("ProjGradOffset", "ProjGradOffset"),
];
static DIMENSIONS: &[&str] = &["1D", "2D", "3D", "Cube", "2DRect", "1DArray", "2DArray"];
/// Other functions whose names had a dimension (EXT_gpu_shader4).
static SIZED: &[(&str, &str)] = &[("texelFetch", "texelFetch"), ("textureSize", "textureSize")];

/// A lookup of old.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Lookup {
    /// The function of today.
    pub(super) name: String,
    /// Whether the old one returns a `vec4`, and the new one a `float`.
    pub(super) is_shadow: bool,
}

/// The lookup with an old name.
pub(super) fn lookup(name: &str) -> Option<Lookup> {
    for (is_shadow, family) in [(false, "texture"), (true, "shadow")] {
        let Some(rest) = name.strip_prefix(family) else { continue };
        let ending = |dimension: &&str| {
            let ending = rest.strip_prefix(*dimension)?;
            ENDINGS.iter().find(|(old, _)| *old == ending).map(|(_, new)| *new)
        };
        if let Some(ending) = DIMENSIONS.iter().find_map(ending) {
            return Some(Lookup { name: format!("texture{ending}"), is_shadow });
        }
    }
    SIZED.iter().find_map(|(old, new)| {
        let rest = name.strip_prefix(old)?;
        let is_old = DIMENSIONS.contains(&rest) || *old == "texelFetch" && rest == "Buffer";
        is_old.then(|| Lookup { name: (*new).to_owned(), is_shadow: false })
    })
}

/// Other words.
pub(super) static WORDS: &[(&str, &str)] = &[
    ("gl_FragDepthEXT", "gl_FragDepth"),
    ("gl_InstanceIDARB", "gl_InstanceID"),
    ("dFdxEXT", "dFdx"),
    ("dFdyEXT", "dFdy"),
];

/// Extensions that the targets have built in; their lines go.
pub(super) static BUILT_IN: &[&str] = &[
    "GL_ARB_compatibility",
    "GL_ARB_draw_buffers",
    "GL_ARB_draw_instanced",
    "GL_ARB_shader_texture_lod",
    "GL_ARB_texture_rectangle",
    "GL_ARB_uniform_buffer_object",
    "GL_EXT_draw_buffers",
    "GL_EXT_draw_instanced",
    "GL_EXT_frag_depth",
    "GL_EXT_gpu_shader4",
    "GL_EXT_shader_texture_lod",
    "GL_EXT_texture_array",
    "GL_OES_standard_derivatives",
    "GL_OES_texture_3D",
];

/// Functions of later versions that the rewritten texts call, so that no name of a program may hide them.
pub(super) static FUNCTIONS: &[&str] =
    &["texture", "textureProj", "textureLod", "textureGrad", "textureSize", "texelFetch"];

/// A name that is not among others.
pub(super) fn free(names: &BTreeSet<String>, wanted: &str) -> String {
    let mut name = wanted.to_owned();
    while names.contains(&name) {
        name.push('0');
    }
    name
}

#[cfg(test)]
mod tests {
    use super::lookup;

    #[test]
    fn lookups_have_one_name() {
        let name = |old| lookup(old).map(|found| (found.name, found.is_shadow));
        assert_eq!(name("texture2D"), Some(("texture".into(), false)));
        assert_eq!(name("texture2DRectProj"), Some(("textureProj".into(), false)));
        assert_eq!(name("textureCubeLodEXT"), Some(("textureLod".into(), false)));
        assert_eq!(name("shadow2DProj"), Some(("textureProj".into(), true)));
        assert_eq!(name("texelFetch2D"), Some(("texelFetch".into(), false)));
        for other in ["texture", "texture2DMine", "shadow", "textureSize", "shadows2D"] {
            assert_eq!(name(other), None, "{other}");
        }
    }
}

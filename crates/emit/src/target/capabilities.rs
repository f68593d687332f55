//! [`Capabilities`]: the means of each target's language, one row for each fact and a list of them for each target.
//!
//! *In:* a target. *Out:* the facts about it that lowering and emission ask for. *Holds:* who asks for a fact names it, and no target: a new
//! target is a list here.

use super::Target;

/// Declares the facts, and lists those of each target.
macro_rules! capabilities {
    (
        $($(#[doc = $doc:literal])* $fact:ident,)*
        ;
        $($target:ident: $($own:ident)*;)*
    ) => {
        /// The means of a target's language, and of the writer for it.
        #[derive(Clone, Copy, Debug, Default)]
        pub(crate) struct Capabilities {
            $($(#[doc = $doc])* pub(crate) $fact: bool,)*
        }

        impl Target {
            /// The means of its language.
            pub(crate) fn capabilities(self) -> Capabilities {
                match self {
                    $(Self::$target => Capabilities { $($own: true,)* ..Capabilities::default() },)*
                }
            }
        }
    };
}

capabilities! {
    /// Points may be larger than a pixel, and fragments know their place in the point.
    has_large_points,
    /// `discard` ends the invocation. Elsewhere it goes on without effects.
    ends_at_discard,
    /// An assignment may write several components of a vector.
    stores_components,
    /// There are arrays of multisample textures.
    has_multisample_arrays,
    /// There is a function for the inverse of a matrix.
    inverts_matrices,
    /// A lookup without a comparison can name the base level.
    names_base_level,
    /// A value can get a second name by a conversion to its own type.
    names_conversions,
    /// A value is used again without a name of its own.
    repeats_values,
    /// A constant vector is made of scalars alone.
    wants_scalar_constituents,
    /// The rows of a window may count from its top, as Vulkan's do.
    may_count_rows_down,
    /// The text of a stage depends on the stage and its interface alone.
    is_written_by_stage,
    ;
    Wgsl: inverts_matrices names_base_level names_conversions repeats_values is_written_by_stage;
    Spirv: has_large_points ends_at_discard stores_components has_multisample_arrays inverts_matrices names_base_level
        wants_scalar_constituents may_count_rows_down is_written_by_stage;
    Msl: has_large_points stores_components has_multisample_arrays names_base_level is_written_by_stage;
    Hlsl: stores_components has_multisample_arrays is_written_by_stage;
    Glsl: has_large_points ends_at_discard stores_components has_multisample_arrays inverts_matrices names_base_level;
}

#[cfg(test)]
mod tests {
    use super::Target;

    #[test]
    fn points_are_large_where_the_language_has_their_size() {
        let large: Vec<&str> = Target::ALL
            .iter()
            .filter(|target| target.capabilities().has_large_points)
            .map(|target| target.name())
            .collect();
        assert_eq!(large, ["SPIR-V", "MSL", "GLSL"]);
    }
}

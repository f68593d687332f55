//! The identities of built-in variables. The table of [`operations`](super::operations) declares those of functions.

macro_rules! identities {
    ($(#[$doc:meta])* $name:ident { $($variant:ident = $spelling:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[expect(missing_docs, reason = "the names are those of the specification")]
        pub enum $name { $($variant,)* }

        impl $name {
            /// All built-in variables.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// The name in GLSL.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $spelling,)* }
            }
        }
    };
}

identities!(
    /// A built-in variable (§7.1, §7.2, §7.5). `gl_in` is the block of a geometry shader's inputs. Its members are
    /// ordinary struct members named `gl_Position`, `gl_PointSize`, `gl_ClipDistance`. `gl_DepthRange` is an ordinary
    /// loose uniform. The linker gives it the default (0, 1, 1).
    BuiltinVariable {
        Position = "gl_Position",
        PointSize = "gl_PointSize",
        ClipDistance = "gl_ClipDistance",
        VertexId = "gl_VertexID",
        InstanceId = "gl_InstanceID",
        In = "gl_in",
        PrimitiveIdIn = "gl_PrimitiveIDIn",
        InvocationId = "gl_InvocationID",
        PrimitiveId = "gl_PrimitiveID",
        Layer = "gl_Layer",
        FragCoord = "gl_FragCoord",
        FrontFacing = "gl_FrontFacing",
        PointCoord = "gl_PointCoord",
        SampleId = "gl_SampleID",
        SampleMaskIn = "gl_SampleMaskIn",
        FragColor = "gl_FragColor",
        FragData = "gl_FragData",
        FragDepth = "gl_FragDepth",
        DepthRange = "gl_DepthRange",
    }
);

//! [`Target`]: the target languages, with one row for each.

/// Declares the targets: `Variant "name" "word" "extension";`
macro_rules! targets {
    ($($target:ident $name:literal $word:literal $extension:literal;)*) => {
        /// A target language.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[expect(missing_docs, reason = "the names say it")]
        pub enum Target {
            $($target,)*
        }

        impl Target {
            /// All targets.
            pub const ALL: &[Self] = &[$(Self::$target),*];

            /// The usual name: `WGSL`.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$target => $name,)*
                }
            }

            /// Its word in options: `wgsl`.
            pub fn word(self) -> &'static str {
                match self {
                    $(Self::$target => $word,)*
                }
            }

            /// The extension of its files: `wgsl`.
            pub fn extension(self) -> &'static str {
                match self {
                    $(Self::$target => $extension,)*
                }
            }
        }
    };
}

targets! {
    Wgsl "WGSL" "wgsl" "wgsl";
    Spirv "SPIR-V" "spirv" "spv";
    Msl "MSL" "msl" "metal";
    Hlsl "HLSL" "hlsl" "hlsl";
    Glsl "GLSL" "glsl" "glsl";
}

impl Target {
    /// Whether all stages of a program can be in one file ([`emit_single_file`](crate::emit_single_file)).
    pub fn has_single_file(self) -> bool {
        match self {
            Self::Wgsl | Self::Msl | Self::Hlsl => true,
            Self::Spirv | Self::Glsl => false,
        }
    }

    /// Whether programs in it are texts.
    pub fn is_text(self) -> bool {
        match self {
            Self::Wgsl | Self::Msl | Self::Hlsl | Self::Glsl => true,
            Self::Spirv => false,
        }
    }

    /// Whether its writer is there: a module for the web may leave out those of MSL and HLSL (the feature `native` of this crate).
    pub fn is_there(self) -> bool {
        match self {
            Self::Msl | Self::Hlsl => cfg!(any(not(target_family = "wasm"), feature = "native")),
            Self::Wgsl | Self::Spirv | Self::Glsl => true,
        }
    }

    /// Whether its programs omit what reaches no output, unless the host asks for everything.
    pub fn omits_unused(self) -> bool {
        match self {
            Self::Wgsl | Self::Spirv => true,
            Self::Msl | Self::Hlsl | Self::Glsl => false,
        }
    }

    /// The target with this word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|target| target.word() == word)
    }
}

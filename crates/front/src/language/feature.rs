//! [`Feature`]: the rules of the language that depend on its version, with one row for each.
//!
//! *In:* a version and the enabled extensions. *Out:* whether the rule is in force. *Holds:* together with the columns of
//! the tables of keywords and built-ins, this table is the only place that compares versions.

use super::extension::Extensions;
use super::section::Edition;
use super::version::{NEVER, Since, Version};

/// A row of the table.
#[derive(Clone, Copy, Debug)]
pub struct FeatureRow {
    /// The feature.
    pub feature: Feature,
    /// The name in messages.
    pub name: &'static str,
    /// The first versions that have it.
    pub since: Since,
    /// The first versions that have it no more; the compatibility profile keeps everything.
    pub gone: Since,
    /// Extensions, each of which adds it to older versions.
    pub extensions: Extensions,
    /// The section that describes it, in the first version that has it.
    pub section: &'static str,
}

macro_rules! features {
    ($($(#[$doc:meta])* $feature:ident $name:literal $since:expr, $gone:expr, $extensions:expr, $section:literal;)*) => {
        /// A rule of the language that depends on its version.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Feature { $($(#[$doc])* $feature),* }

        /// All rows, in the order of the enum.
        pub static FEATURES: &[FeatureRow] = &[$(FeatureRow {
            feature: Feature::$feature,
            name: $name,
            since: $since,
            gone: $gone,
            extensions: $extensions,
            section: $section,
        }),*];
    };
}

const PACK: Extensions = Extensions::SHADING_LANGUAGE_420PACK;
const SHADER4: Extensions = Extensions::GPU_SHADER4;
const SHADER5: Extensions = Extensions::GPU_SHADER5;
const NONE: Extensions = Extensions::empty();
const STAYS: Since = Since::NEVER;

const fn since(desktop: u16, es: u16) -> Since {
    Since::new(desktop, es)
}

features! {
    /// `%`, `&`, `|`, `^`, `~`, `<<`, `>>` and their assignments.
    IntegerOperators "an operator on the bits of integers" since(130, 300), STAYS, SHADER4, "§5.9";
    /// `1u`
    UnsignedLiterals "an unsigned literal" since(130, 300), STAYS, SHADER4, "§4.1.3";
    /// `1.0f`
    FloatSuffix "the suffix `f`" since(120, 300), STAYS, NONE, "§4.1.4";
    /// `##` in macros.
    TokenPasting "`##`" since(130, 300), STAYS, NONE, "§3.3";
    /// `#extension GL_ARB_compatibility`
    CompatibilityExtension "GL_ARB_compatibility" since(140, NEVER), STAYS, NONE, "§3.3";
    /// Arrays as `out` and `inout` arguments.
    ArrayArguments "an array that a function writes" since(120, 100), STAYS, NONE, "§6.1";
    /// Precision qualifiers, and the macro that tells that `highp` is there.
    Precision "a precision qualifier" since(130, 100), STAYS, NONE, "§4.5";
    /// `\` at the end of a line.
    LineContinuation "a joined line" since(420, 300), STAYS, PACK, "§3.2";
    /// The number of `#line` is that of the next line; before, of the line itself.
    LineNumbersNext "`#line` for the next line" since(330, 300), STAYS, NONE, "§3.3";
    /// A comment over several lines is one space, also in a directive; before, "New-lines are not eliminated by comments".
    CommentsAreSpaces "a comment over several lines in a directive" since(440, 300), STAYS, NONE, "§3.4";
    /// A name in `#if` that is no macro "causes an error".
    NamesInConditions "the rule for names in conditions" since(NEVER, 100), STAYS, NONE, "§3.4";
    /// Nothing but a comment follows a directive, as every compiler of ES wants it.
    DirectiveEnds "the rule for text after directives" since(NEVER, 100), STAYS, NONE, "§3.4";
    /// `#extension` comes "before any non-preprocessor tokens", as every compiler of ES 3.00 wants it; those of 1.00 warn.
    ExtensionsFirst "the rule for the place of `#extension`" since(NEVER, 300), STAYS, NONE, "§3.5";
    /// "The maximum length of an identifier is 1024 characters."
    ShortNames "the rule for the length of names" since(NEVER, 300), STAYS, NONE, "§3.9";
    /// `precision lowp sampler2D;`
    SamplerPrecision "a default precision of samplers" since(440, 100), STAYS, NONE, "§4.7.3";
    /// A lone `;` at global scope.
    EmptyDeclarations "an empty declaration" since(460, NEVER), STAYS, NONE, "§9";
    /// `in` and `out` at global scope.
    InOut "a global `in` or `out`" since(130, 300), STAYS, NONE, "§4.3";
    /// `attribute` and `varying`.
    Attributes "`attribute` and `varying`" since(110, 100), since(420, 300), NONE, "§4.3";
    /// Integers as inputs and outputs of stages.
    IntegerInterfaces "an integer that crosses the interface of a stage" since(130, 300), STAYS, SHADER4, "§4.3.4";
    /// Structs between stages.
    StructInterfaces "a struct between stages" since(150, 300), STAYS, NONE, "§4.3.4";
    /// Arrays as inputs of vertex shaders.
    ArrayAttributes "an array as an attribute" since(150, NEVER), STAYS, NONE, "§4.3.4";
    /// Array constructors, initializers, assignment, comparison, `length()`, and arrays as results of functions.
    ArrayObjects "an array as a value" since(120, 300), STAYS, NONE, "§4.1.9";
    /// `float[2] a`; before, `float a[2]` alone.
    ArrayTypes "the size of an array before its name" since(120, 300), STAYS, NONE, "§4.1.9";
    /// `float[2][3]`
    ArraysOfArrays "an array of arrays" since(430, 310), STAYS, Extensions::ARRAYS_OF_ARRAYS, "§4.1.9";
    /// `mat3(m)` of a matrix.
    MatrixFromMatrix "a matrix from a matrix" since(120, 100), STAYS, NONE, "§5.4.2";
    /// `uniform float a = 1.0;`
    UniformInitializers "the initializer of a uniform" since(120, NEVER), STAYS, NONE, "§4.3.5";
    /// Initializers of globals that are not constant expressions.
    GlobalInitializers "an initializer of a global that is not constant" since(110, NEVER), STAYS, NONE, "§4.3";
    /// Such initializers with a warning, where they read uniforms and globals alone, as WebGL has it.
    LooseGlobalInitializers "an initializer of a global that is not constant" since(NEVER, 100), Since::new(NEVER, 300),
        NONE, "§4.3";
    /// Calls of built-in functions in constant expressions.
    ConstantFunctions "a function in a constant expression" since(120, 100), STAYS, NONE, "§4.3.3";
    /// `int` to `float`; from 1.30 on also `uint` to `float`.
    ImplicitToFloat "the implicit conversion to `float`" since(120, NEVER), STAYS, SHADER4, "§4.1.10";
    /// `int` to `uint`.
    ImplicitToUint "the implicit conversion to `uint`" since(400, NEVER), STAYS, SHADER5, "§4.1.10";
    /// The order of conversions among overloads.
    BestOverload "the best of several overloads" since(400, NEVER), STAYS, SHADER5, "§6.1";
    /// `uniform B { .. };`
    UniformBlocks "a uniform block" since(140, 300), STAYS, Extensions::UNIFORM_BUFFER_OBJECT, "§4.3.7";
    /// `in` and `out` blocks.
    InterfaceBlocks "an `in` or `out` block" since(150, 320), STAYS, NONE, "§4.3.7";
    /// Arrays of blocks, and names for their instances.
    BlockInstances "a block with an instance name" since(150, 300), STAYS, Extensions::UNIFORM_BUFFER_OBJECT, "§4.3.7";
    /// Initializer lists in braces.
    InitializerLists "an initializer list" since(420, NEVER), STAYS, PACK, "§4.1.11";
    /// `const` locals with any initializer.
    DynamicConstants "a `const` whose value is not a constant expression" since(420, NEVER), STAYS, PACK, "§4.3.2";
    /// Qualifiers in any order.
    QualifierOrder "qualifiers in this order" since(420, 310), STAYS, PACK, "§4.7";
    /// Several `layout(..)` in one declaration.
    RepeatedLayouts "a second `layout`" since(420, 310), STAYS, PACK, "§4.4";
    /// "The qualifier may appear at most once within a declaration"; later versions take the last.
    OneLocation "the rule for a second `location`" since(NEVER, 300), since(NEVER, 310), NONE, "§4.3.8.2";
    /// A `layout` and `invariant` exclude each other: the grammar has a layout before a storage qualifier alone.
    NoInvariantLayout "the rule for `invariant` with a layout" since(NEVER, 300), since(NEVER, 310), NONE, "§4.7";
    /// `x.xxx` of a scalar.
    ScalarSwizzles "a swizzle of a scalar" since(420, NEVER), STAYS, PACK, "§5.5";
    /// `length()` of vectors and matrices.
    VectorLength "the length of a vector" since(420, NEVER), STAYS, PACK, "§5.7";
    /// The value of `return` is converted.
    ReturnConversions "a converted `return` value" since(420, NEVER), STAYS, PACK, "§6.4";
    /// Layout values that are constant expressions.
    LayoutExpressions "a layout value that is not a literal" since(440, NEVER), STAYS,
        Extensions::ENHANCED_LAYOUTS, "§4.4";
    /// `layout(depth_greater) out float gl_FragDepth;`
    DepthLayouts "a layout of `gl_FragDepth`" since(420, NEVER), STAYS, Extensions::CONSERVATIVE_DEPTH, "§4.4.2";
    /// Redeclaring `gl_PerVertex`.
    PerVertex "a declaration of `gl_PerVertex`" since(410, NEVER), STAYS, Extensions::SEPARATE_SHADER_OBJECTS, "§7.1";
    /// Samplers, and blocks, are indexed by constant expressions alone.
    ConstantSamplers "the rule for the index of a sampler" since(130, 300), since(400, 320), NONE, "§4.1.7";
    /// Texture offsets that are not constant expressions (`textureGatherOffset`).
    DynamicOffsets "a texture offset that is not constant" since(400, 320), STAYS, SHADER5, "§8.9";
    /// Layout identifiers in capitals.
    AnyCaseLayouts "a layout identifier in capitals" since(140, NEVER), since(440, NEVER), NONE, "§4.3.5.2";
    /// A shader declares a function that is built in.
    BuiltinsHidden "a function with the name of a built-in one" since(110, NEVER), STAYS, NONE, "§6.1";
    /// Structs without a name.
    NamelessStructs "a struct without a name" since(110, 100), STAYS, NONE, "§4.1.8";
    /// Inputs of fragment shaders may be invariant, as the outputs that feed them.
    InvariantInputs "an invariant input" since(120, 100), Since::new(420, 300), NONE, "§4.6.1";
    /// Functions share the name space of variables; in 1.10 they have their own.
    SharedNames "one name space for functions and variables" since(120, 100), STAYS, NONE, "§4.2";
    /// Functions are declared at global scope alone.
    GlobalPrototypes "prototypes at global scope alone" since(120, 100), STAYS, NONE, "§4.2";
    /// The parameters and the body of a function are one scope.
    ParameterScope "one scope for parameters and body" since(430, 300), STAYS, NONE, "§4.2";
    /// A prototype that repeats another.
    RepeatedPrototypes "a second prototype" since(110, 300), STAYS, NONE, "§4.2";
    /// A function with the name of a built-in one, but other parameters.
    BuiltinOverloads "an overload of a built-in function" since(110, 100), Since::new(NEVER, 300), NONE, "§6.1";
    /// Global variables with the names of built-in functions, which are in an outer scope.
    BuiltinScope "a global with the name of a built-in function" since(110, 100), Since::new(NEVER, 300), NONE, "§4.2";
    /// Structs that contain arrays are assigned, compared and returned.
    ArraysInValues "a struct with an array as a value" since(110, 300), STAYS, NONE, "§5.8";
    /// The comma makes no constant expression: "the sequence operator ( , ) .. `is` not included".
    VariableSequences "no comma in a constant expression" since(430, 300), STAYS, NONE, "§4.3.3";
    /// `float a[];`
    UnsizedArrays "an array without a size" since(110, NEVER), STAYS, NONE, "§4.1.9";
    /// Indices of outputs that are arrays.
    DynamicOutputs "a fragment output with an index that is not constant" since(130, 320), STAYS, NONE, "§4.3.6";
    /// `#pragma STDGL invariant(all)` in fragment shaders. Versions between say: "It is an error to use this pragma in a fragment shader".
    FragmentPragma "the pragma `invariant(all)` in a fragment shader" since(450, 310), STAYS, NONE, "§4.8.1";
    /// Such a pragma in the first version of ES.
    EarlyFragmentPragma "the pragma `invariant(all)` in a fragment shader" since(NEVER, 100), Since::new(NEVER, 300),
        NONE, "§4.6.1";
    /// Inputs that no output of the stage before feeds with a value.
    UnwrittenInputs "an input that the stage before does not write" since(150, 100), STAYS, NONE, "§4.3.4";
    /// An `invariant` output matches an input that is not.
    InvariantOutputAlone "an `invariant` output alone" since(420, 300), STAYS, NONE, "§4.8.1";
    /// Integer outputs of vertex shaders that are not `flat`: only the inputs of fragment shaders must be.
    IntegerOutputs "an integer output that is not `flat`" since(150, 320), STAYS, NONE, "§4.3.4";
    /// Attributes of one location, of which no run of the shader reads two; ES 3.00 has "the linker must report an error" (§12.46).
    AttributeAliasing "attributes that share a location" since(110, 100), since(NEVER, 300), NONE, "§4.3.4";
    /// One interface has no member of a block without an instance name and another declaration of one name.
    InterfaceNames "the rule for names in an interface" since(440, 310), STAYS, NONE, "§4.3.9";
    /// The precision of a member of a uniform block may differ between stages.
    BlockPrecisions "another precision of a member in each stage" since(NEVER, 310), STAYS, NONE, "§4.3.9";
    /// Without an interpolation qualifier, "smooth interpolation is used", so that `smooth` matches its absence.
    SmoothByDefault "`smooth` in one stage alone" since(NEVER, 310), STAYS, NONE, "§4.5";
    /// `#version` "must be present in the first line of a shader" (GLSL ES 3.00 §3.4).
    VersionOnFirstLine "the rule for the line of `#version`" since(NEVER, 300), STAYS, NONE, "§3.4";
    /// The interpolation of an output may differ from that of the input that it feeds, which decides.
    InterpolationOfInput "an output with another interpolation than its input" since(430, NEVER), STAYS, NONE, "§4.3.4";
    /// An output may differ so in `centroid` and `sample`, too.
    SamplingOfInput "an output that is `centroid` alone" since(430, 310), STAYS, NONE, "§4.3.4";
}

impl FeatureRow {
    /// The version whose section is cited: the first that has it.
    pub fn origin(&self) -> Option<Edition> {
        let Since { desktop, es } = self.since;
        match (desktop, es) {
            (NEVER, NEVER) => None,
            (NEVER, number) => Some(Edition { es: true, number }),
            (number, _) => Some(Edition { es: false, number }),
        }
    }
}

impl Feature {
    /// Its row.
    pub fn row(self) -> &'static FeatureRow {
        static MISSING: FeatureRow = FeatureRow {
            feature: Feature::IntegerOperators,
            name: "",
            since: Since::NEVER,
            gone: Since::NEVER,
            extensions: Extensions::empty(),
            section: "",
        };
        FEATURES.get(self as usize).unwrap_or(&MISSING)
    }
}

impl Version {
    /// Whether the language has a feature without an extension.
    pub fn has(self, feature: Feature) -> bool {
        let row = feature.row();
        self.reaches(row.since) && self.still_has(row.gone)
    }

    /// Whether the language has a feature with these extensions.
    pub fn has_with(self, feature: Feature, extensions: Extensions) -> bool {
        self.has(feature) || feature.row().extensions.intersects(extensions)
    }

    /// The first version of this family that has something: `#version 330`.
    pub fn first(self, since: Since) -> Option<String> {
        match (self.is_es(), since.desktop, since.es) {
            (true, _, NEVER) | (false, NEVER, _) => None,
            (true, _, es @ ..=100) => Some(format!("#version {es}")),
            (true, _, es) => Some(format!("#version {es} es")),
            (false, desktop, _) => Some(format!("#version {desktop}")),
        }
    }

    /// How a source of this version gets something: by another version, or by an extension.
    pub(crate) fn remedy(self, since: Since, gone: Since, extensions: Extensions) -> Option<String> {
        if self.reaches(since) && !self.still_has(gone) {
            let last = if self.is_es() { gone.es } else { gone.desktop };
            return Some(format!("versions before {} have it", Self { number: last, ..self }.name()));
        }
        let first = self.first(since).map(|line| format!("`{line}` has it"));
        let extension = extensions.name_for(self);
        let extension = extension.map(|name| format!("put `#extension {name} : enable` at the top"));
        match (first, extension) {
            (Some(first), Some(extension)) => Some(format!("{first}, or {extension}")),
            (first, extension) => first.or(extension),
        }
        .or_else(|| {
            let other = if self.is_es() { since.desktop } else { since.es };
            (other != NEVER)
                .then(|| if self.is_es() { "only OpenGL has it" } else { "only OpenGL ES has it" }.to_owned())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::Profile;
    use crate::source::Span;

    fn version(number: u16, profile: Profile) -> Version {
        Version { number, profile, span: Span::default() }
    }

    #[test]
    fn rows_are_in_the_order_of_the_enum() {
        for (index, row) in FEATURES.iter().enumerate() {
            assert_eq!(row.feature as usize, index, "{}", row.name);
            assert_eq!(row.feature.row().name, row.name);
        }
    }

    #[test]
    fn versions_profiles_and_extensions_decide() {
        let core = |number| version(number, Profile::Core);
        assert!(!core(110).has(Feature::ImplicitToFloat) && core(120).has(Feature::ImplicitToFloat));
        assert!(!version(300, Profile::Es).has(Feature::ImplicitToFloat));
        assert!(core(410).has(Feature::Attributes) && !core(420).has(Feature::Attributes));
        assert!(version(460, Profile::Compatibility).has(Feature::Attributes));
        assert!(
            !version(300, Profile::Es).has(Feature::Attributes) && version(100, Profile::Es).has(Feature::Attributes)
        );
        assert!(core(150).has_with(Feature::ImplicitToUint, Extensions::GPU_SHADER5));
        assert!(!core(150).has_with(Feature::ImplicitToUint, Extensions::SHADING_LANGUAGE_420PACK));
    }

    #[test]
    fn the_first_version_is_named_as_it_is_written() {
        let first = |version: Version, since| version.first(since);
        assert_eq!(first(version(150, Profile::Core), Since::new(330, 300)).as_deref(), Some("#version 330"));
        assert_eq!(first(version(100, Profile::Es), Since::new(330, 300)).as_deref(), Some("#version 300 es"));
        assert_eq!(first(version(100, Profile::Es), Since::new(330, NEVER)), None);
    }
}

//! The words of the language as data (GLSL 1.50 §3.6): in which versions each is a keyword and in which it is only
//! reserved, and which extensions make it a keyword.
//!
//! *Holds:* row *n* is symbol *n* of [`Names::with_keywords`](super::names::Names::with_keywords).
//! Names that begin with `gl_`, built-in functions and the names inside `layout(..)` are not keywords; they are not
//! here.

use super::token::TokenKind::{self, *};
use crate::language::{Extensions, NEVER, Since, Version};
use std::sync::OnceLock;

/// A word of the language.
#[derive(Clone, Copy, Debug)]
pub struct Keyword {
    /// The spelling.
    pub spelling: &'static str,
    /// The token kind of the keyword.
    pub kind: TokenKind,
    /// The first versions in which it is a keyword.
    pub keyword: Since,
    /// The first versions in which using it is an error.
    pub reserved: Since,
    /// The first versions in which a word that was only reserved is a name again.
    pub free: Since,
    /// Extensions, each of which makes it a keyword.
    pub extensions: Extensions,
}

const fn word(spelling: &'static str, kind: TokenKind, desktop: (u16, u16), es: (u16, u16)) -> Keyword {
    let (keyword, reserved) = (Since::new(desktop.0, es.0), Since::new(desktop.1, es.1));
    Keyword { spelling, kind, keyword, reserved, free: Since::NEVER, extensions: Extensions::empty() }
}

const SHADER4: Extensions = Extensions::GPU_SHADER4;
const ARRAY: Extensions = Extensions::TEXTURE_ARRAY.union(Extensions::GPU_SHADER4);
const MULTISAMPLE: Extensions = Extensions::TEXTURE_MULTISAMPLE;
const CUBE_ARRAYS: Extensions = Extensions::TEXTURE_CUBE_MAP_ARRAY;
const SHADER5: Extensions = Extensions::GPU_SHADER5;
const LAYOUT: Extensions = Extensions::EXPLICIT_ATTRIB_LOCATION
    .union(Extensions::UNIFORM_BUFFER_OBJECT)
    .union(Extensions::FRAGMENT_COORD_CONVENTIONS)
    .union(Extensions::SHADING_LANGUAGE_420PACK)
    .union(Extensions::SEPARATE_SHADER_OBJECTS)
    .union(Extensions::EXPLICIT_UNIFORM_LOCATION)
    .union(Extensions::CONSERVATIVE_DEPTH);

impl Keyword {
    /// The same word, which each of these extensions makes a keyword.
    const fn or(self, extensions: Extensions) -> Self {
        Self { extensions, ..self }
    }

    /// The same word, which these versions reserve no more.
    const fn until(self, desktop: u16, es: u16) -> Self {
        Self { free: Since::new(desktop, es), ..self }
    }

    /// The token kind of the word in a language. What came later, the keyword or its reservation, counts.
    pub fn kind_in(&self, version: Version, extensions: Extensions) -> TokenKind {
        let later = |a: Since, b: Since| if version.is_es() { a.es > b.es } else { a.desktop > b.desktop };
        let (keyword, reserved) = (version.reaches(self.keyword), version.reaches(self.reserved));
        if self.extensions.intersects(extensions) || (keyword && !(reserved && later(self.reserved, self.keyword))) {
            self.kind
        } else if reserved && !version.reaches(self.free) {
            Reserved
        } else {
            Ident
        }
    }
}

/// The class of a word, for highlighting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WordClass {
    /// A statement, qualifier or other keyword.
    Keyword,
    /// The name of a type.
    Type,
    /// `true` or `false`.
    Constant,
    /// A name that begins with `gl_`.
    Builtin,
}

impl WordClass {
    /// The class of a word in a version; `None` for names that an author chooses, and for words that are only
    /// reserved.
    pub fn of(word: &str, version: Version) -> Option<Self> {
        if word.starts_with("gl_") {
            return Some(Self::Builtin);
        }
        match TABLE.iter().find(|row| row.spelling == word)?.kind_in(version, Extensions::empty()) {
            Type | Void => Some(Self::Type),
            True | False => Some(Self::Constant),
            Ident | Reserved => None,
            _ => Some(Self::Keyword),
        }
    }
}

/// Whether a word is a keyword of a language or reserved in it, so that no name of a program can be that word.
pub fn is_taken(word: &str, version: Version) -> bool {
    let row = TABLE.iter().find(|row| row.spelling == word);
    row.is_some_and(|row| row.kind_in(version, Extensions::empty()) != Ident)
}

/// Whether a word is a keyword of a language with some extensions.
pub(crate) fn is_keyword(word: &str, version: Version, extensions: Extensions) -> bool {
    let row = TABLE.iter().find(|row| row.spelling == word);
    row.is_some_and(|row| !matches!(row.kind_in(version, extensions), Ident | Reserved))
}

/// Whether a word is a type of GLSL for Vulkan alone (GL_KHR_vulkan_glsl).
pub fn is_of_vulkan(word: &str) -> bool {
    VULKAN.binary_search(&word).is_ok()
}

/// The types that GL_KHR_vulkan_glsl adds, in order: textures and samplers apart, and attachments that are read.
static VULKAN: &[&str] = &[
    "isubpassInput",
    "isubpassInputMS",
    "itexture1D",
    "itexture1DArray",
    "itexture2D",
    "itexture2DArray",
    "itexture2DMS",
    "itexture2DMSArray",
    "itexture2DRect",
    "itexture3D",
    "itextureBuffer",
    "itextureCube",
    "itextureCubeArray",
    "sampler",
    "samplerShadow",
    "subpassInput",
    "subpassInputMS",
    "texture1D",
    "texture1DArray",
    "texture2D",
    "texture2DArray",
    "texture2DMS",
    "texture2DMSArray",
    "texture2DRect",
    "texture3D",
    "textureBuffer",
    "textureCube",
    "textureCubeArray",
    "usubpassInput",
    "usubpassInputMS",
    "utexture1D",
    "utexture1DArray",
    "utexture2D",
    "utexture2DArray",
    "utexture2DMS",
    "utexture2DMSArray",
    "utexture2DRect",
    "utexture3D",
    "utextureBuffer",
    "utextureCube",
    "utextureCubeArray",
];

/// The token kind of each word of the table in a language, by symbol.
pub(super) fn kinds_in(version: Version, extensions: Extensions) -> Vec<TokenKind> {
    let kinds = || TABLE.iter().map(|row| row.kind_in(version, extensions)).collect();
    let place = usize::from(version.number / 10) + if version.is_es() { TENS } else { 0 };
    match PLAIN.get(place) {
        Some(plain) if extensions.is_empty() && version.number.is_multiple_of(10) => plain.get_or_init(kinds).clone(),
        _ => kinds(),
    }
}

/// More than a tenth of each version number.
const TENS: usize = 64;
/// The kinds without extensions, by a tenth of the version's number; those of ES in the second half.
static PLAIN: [OnceLock<Vec<TokenKind>>; 2 * TENS] = [const { OnceLock::new() }; 2 * TENS];

/// All words that are keywords or reserved in some version: the first desktop versions in which each is a keyword and
/// in which it is reserved, and the same of ES.
#[rustfmt::skip]
pub static TABLE: &[Keyword] = &[
    word("float", Type, (110, NEVER), (100, NEVER)),
    word("int", Type, (110, NEVER), (100, NEVER)),
    word("bool", Type, (110, NEVER), (100, NEVER)),
    word("mat2", Type, (110, NEVER), (100, NEVER)),
    word("mat3", Type, (110, NEVER), (100, NEVER)),
    word("mat4", Type, (110, NEVER), (100, NEVER)),
    word("mat2x2", Type, (120, NEVER), (300, NEVER)),
    word("mat2x3", Type, (120, NEVER), (300, NEVER)),
    word("mat2x4", Type, (120, NEVER), (300, NEVER)),
    word("mat3x2", Type, (120, NEVER), (300, NEVER)),
    word("mat3x3", Type, (120, NEVER), (300, NEVER)),
    word("mat3x4", Type, (120, NEVER), (300, NEVER)),
    word("mat4x2", Type, (120, NEVER), (300, NEVER)),
    word("mat4x3", Type, (120, NEVER), (300, NEVER)),
    word("mat4x4", Type, (120, NEVER), (300, NEVER)),
    word("vec2", Type, (110, NEVER), (100, NEVER)),
    word("vec3", Type, (110, NEVER), (100, NEVER)),
    word("vec4", Type, (110, NEVER), (100, NEVER)),
    word("ivec2", Type, (110, NEVER), (100, NEVER)),
    word("ivec3", Type, (110, NEVER), (100, NEVER)),
    word("ivec4", Type, (110, NEVER), (100, NEVER)),
    word("bvec2", Type, (110, NEVER), (100, NEVER)),
    word("bvec3", Type, (110, NEVER), (100, NEVER)),
    word("bvec4", Type, (110, NEVER), (100, NEVER)),
    word("uint", Type, (130, NEVER), (300, NEVER)),
    word("uvec2", Type, (130, NEVER), (300, NEVER)).or(SHADER4),
    word("uvec3", Type, (130, NEVER), (300, NEVER)).or(SHADER4),
    word("uvec4", Type, (130, NEVER), (300, NEVER)).or(SHADER4),
    word("sampler1D", Type, (110, NEVER), (NEVER, 100)),
    word("sampler2D", Type, (110, NEVER), (100, NEVER)),
    word("sampler3D", Type, (110, NEVER), (300, 100)),
    word("samplerCube", Type, (110, NEVER), (100, NEVER)),
    word("sampler1DShadow", Type, (110, NEVER), (NEVER, 100)),
    word("sampler2DShadow", Type, (110, NEVER), (300, 100)),
    word("samplerCubeShadow", Type, (130, NEVER), (300, NEVER)).or(SHADER4),
    word("sampler1DArray", Type, (130, NEVER), (NEVER, 300)).or(ARRAY),
    word("sampler2DArray", Type, (130, NEVER), (300, NEVER)).or(ARRAY),
    word("sampler1DArrayShadow", Type, (130, NEVER), (NEVER, 300)).or(ARRAY),
    word("sampler2DArrayShadow", Type, (130, NEVER), (300, NEVER)).or(ARRAY),
    word("isampler1D", Type, (130, NEVER), (NEVER, 300)).or(SHADER4),
    word("isampler2D", Type, (130, NEVER), (300, NEVER)).or(SHADER4),
    word("isampler3D", Type, (130, NEVER), (300, NEVER)).or(SHADER4),
    word("isamplerCube", Type, (130, NEVER), (300, NEVER)).or(SHADER4),
    word("isampler1DArray", Type, (130, NEVER), (NEVER, 300)).or(SHADER4),
    word("isampler2DArray", Type, (130, NEVER), (300, NEVER)).or(SHADER4),
    word("usampler1D", Type, (130, NEVER), (NEVER, 300)).or(SHADER4),
    word("usampler2D", Type, (130, NEVER), (300, NEVER)).or(SHADER4),
    word("usampler3D", Type, (130, NEVER), (300, NEVER)).or(SHADER4),
    word("usamplerCube", Type, (130, NEVER), (300, NEVER)).or(SHADER4),
    word("usampler1DArray", Type, (130, NEVER), (NEVER, 300)).or(SHADER4),
    word("usampler2DArray", Type, (130, NEVER), (300, NEVER)).or(SHADER4),
    word("sampler2DRect", Type, (110, NEVER), (NEVER, 100)),
    word("sampler2DRectShadow", Type, (110, NEVER), (NEVER, 100)),
    word("isampler2DRect", Type, (140, 130), (NEVER, 300)).or(SHADER4),
    word("usampler2DRect", Type, (140, 130), (NEVER, 300)).or(SHADER4),
    word("samplerBuffer", Type, (140, 130), (320, 300)).or(SHADER4),
    word("isamplerBuffer", Type, (140, 130), (320, 300)).or(SHADER4),
    word("usamplerBuffer", Type, (140, 130), (320, 300)).or(SHADER4),
    word("sampler2DMS", Type, (150, NEVER), (310, 300)).or(MULTISAMPLE),
    word("isampler2DMS", Type, (150, NEVER), (310, 300)).or(MULTISAMPLE),
    word("usampler2DMS", Type, (150, NEVER), (310, 300)).or(MULTISAMPLE),
    word("sampler2DMSArray", Type, (150, NEVER), (320, 300)).or(MULTISAMPLE),
    word("isampler2DMSArray", Type, (150, NEVER), (320, 300)).or(MULTISAMPLE),
    word("usampler2DMSArray", Type, (150, NEVER), (320, 300)).or(MULTISAMPLE),
    word("attribute", Attribute, (110, NEVER), (100, 300)),
    word("const", Const, (110, NEVER), (100, NEVER)),
    word("uniform", Uniform, (110, NEVER), (100, NEVER)),
    word("varying", Varying, (110, NEVER), (100, 300)),
    word("layout", Layout, (140, NEVER), (300, NEVER)).or(LAYOUT),
    word("centroid", Centroid, (120, NEVER), (300, NEVER)).or(SHADER4),
    word("flat", Flat, (130, NEVER), (300, 100)).or(SHADER4),
    word("smooth", Smooth, (130, NEVER), (300, NEVER)),
    word("noperspective", Noperspective, (130, NEVER), (NEVER, 300)).or(SHADER4),
    word("break", Break, (110, NEVER), (100, NEVER)),
    word("continue", Continue, (110, NEVER), (100, NEVER)),
    word("do", Do, (110, NEVER), (100, NEVER)),
    word("for", For, (110, NEVER), (100, NEVER)),
    word("while", While, (110, NEVER), (100, NEVER)),
    word("switch", Switch, (130, 110), (300, 100)),
    word("case", Case, (130, NEVER), (300, NEVER)),
    word("default", Default, (130, 110), (300, 100)),
    word("if", If, (110, NEVER), (100, NEVER)),
    word("else", Else, (110, NEVER), (100, NEVER)),
    word("in", In, (110, NEVER), (100, NEVER)),
    word("out", Out, (110, NEVER), (100, NEVER)),
    word("inout", Inout, (110, NEVER), (100, NEVER)),
    word("void", Void, (110, NEVER), (100, NEVER)),
    word("true", True, (110, NEVER), (100, NEVER)),
    word("false", False, (110, NEVER), (100, NEVER)),
    word("invariant", Invariant, (120, NEVER), (100, NEVER)),
    word("discard", Discard, (110, NEVER), (100, NEVER)),
    word("return", Return, (110, NEVER), (100, NEVER)),
    word("lowp", Lowp, (130, 120), (100, NEVER)),
    word("mediump", Mediump, (130, 120), (100, NEVER)),
    word("highp", Highp, (130, 120), (100, NEVER)),
    word("precision", Precision, (130, 120), (100, NEVER)),
    word("struct", Struct, (110, NEVER), (100, NEVER)),
    word("common", Reserved, (NEVER, 130), (NEVER, 300)),
    word("partition", Reserved, (NEVER, 130), (NEVER, 300)),
    word("active", Reserved, (NEVER, 130), (NEVER, 300)),
    word("asm", Reserved, (NEVER, 110), (NEVER, 100)),
    word("class", Reserved, (NEVER, 110), (NEVER, 100)),
    word("union", Reserved, (NEVER, 110), (NEVER, 100)),
    word("enum", Reserved, (NEVER, 110), (NEVER, 100)),
    word("typedef", Reserved, (NEVER, 110), (NEVER, 100)),
    word("template", Reserved, (NEVER, 110), (NEVER, 100)),
    word("this", Reserved, (NEVER, 110), (NEVER, 100)),
    word("packed", Reserved, (NEVER, 110), (NEVER, 100)).until(440, 300),
    word("goto", Reserved, (NEVER, 110), (NEVER, 100)),
    word("inline", Reserved, (NEVER, 110), (NEVER, 100)),
    word("noinline", Reserved, (NEVER, 110), (NEVER, 100)),
    word("volatile", Foreign, (420, 110), (310, 100)),
    word("public", Reserved, (NEVER, 110), (NEVER, 100)),
    word("static", Reserved, (NEVER, 110), (NEVER, 100)),
    word("extern", Reserved, (NEVER, 110), (NEVER, 100)),
    word("external", Reserved, (NEVER, 110), (NEVER, 100)),
    word("interface", Reserved, (NEVER, 110), (NEVER, 100)),
    word("long", Reserved, (NEVER, 110), (NEVER, 100)),
    word("short", Reserved, (NEVER, 110), (NEVER, 100)),
    word("double", Foreign, (400, 110), (NEVER, 100)),
    word("half", Reserved, (NEVER, 110), (NEVER, 100)),
    word("fixed", Reserved, (NEVER, 110), (NEVER, 100)),
    word("unsigned", Unsigned, (NEVER, 110), (NEVER, 100)).or(SHADER4),
    word("superp", Reserved, (NEVER, 130), (NEVER, 100)),
    word("input", Reserved, (NEVER, 110), (NEVER, 100)),
    word("output", Reserved, (NEVER, 110), (NEVER, 100)),
    word("hvec2", Reserved, (NEVER, 110), (NEVER, 100)),
    word("hvec3", Reserved, (NEVER, 110), (NEVER, 100)),
    word("hvec4", Reserved, (NEVER, 110), (NEVER, 100)),
    word("dvec2", Foreign, (400, 110), (NEVER, 100)),
    word("dvec3", Foreign, (400, 110), (NEVER, 100)),
    word("dvec4", Foreign, (400, 110), (NEVER, 100)),
    word("fvec2", Reserved, (NEVER, 110), (NEVER, 100)),
    word("fvec3", Reserved, (NEVER, 110), (NEVER, 100)),
    word("fvec4", Reserved, (NEVER, 110), (NEVER, 100)),
    word("sampler3DRect", Reserved, (NEVER, 110), (NEVER, 100)),
    word("filter", Reserved, (NEVER, 130), (NEVER, 300)),
    word("image1D", Foreign, (420, 130), (NEVER, 300)),
    word("image2D", Foreign, (420, 130), (310, 300)),
    word("image3D", Foreign, (420, 130), (310, 300)),
    word("imageCube", Foreign, (420, 130), (310, 300)),
    word("iimage1D", Foreign, (420, 130), (NEVER, 300)),
    word("iimage2D", Foreign, (420, 130), (310, 300)),
    word("iimage3D", Foreign, (420, 130), (310, 300)),
    word("iimageCube", Foreign, (420, 130), (310, 300)),
    word("uimage1D", Foreign, (420, 130), (NEVER, 300)),
    word("uimage2D", Foreign, (420, 130), (310, 300)),
    word("uimage3D", Foreign, (420, 130), (310, 300)),
    word("uimageCube", Foreign, (420, 130), (310, 300)),
    word("image1DArray", Foreign, (420, 130), (NEVER, 300)),
    word("image2DArray", Foreign, (420, 130), (310, 300)),
    word("iimage1DArray", Foreign, (420, 130), (NEVER, 300)),
    word("iimage2DArray", Foreign, (420, 130), (310, 300)),
    word("uimage1DArray", Foreign, (420, 130), (NEVER, 300)),
    word("uimage2DArray", Foreign, (420, 130), (310, 300)),
    word("image1DShadow", Reserved, (NEVER, 130), (NEVER, NEVER)).until(420, NEVER),
    word("image2DShadow", Reserved, (NEVER, 130), (NEVER, NEVER)).until(420, NEVER),
    word("image1DArrayShadow", Reserved, (NEVER, 130), (NEVER, NEVER)).until(420, NEVER),
    word("image2DArrayShadow", Reserved, (NEVER, 130), (NEVER, NEVER)).until(420, NEVER),
    word("imageBuffer", Foreign, (420, 130), (320, 300)),
    word("iimageBuffer", Foreign, (420, 130), (320, 300)),
    word("uimageBuffer", Foreign, (420, 130), (320, 300)),
    word("sizeof", Reserved, (NEVER, 110), (NEVER, 100)),
    word("cast", Reserved, (NEVER, 110), (NEVER, 100)),
    word("namespace", Reserved, (NEVER, 110), (NEVER, 100)),
    word("using", Reserved, (NEVER, 110), (NEVER, 100)),
    word("row_major", Reserved, (NEVER, 130), (NEVER, NEVER)).until(440, NEVER),
    word("precise", Precise, (400, NEVER), (320, 310)).or(SHADER5),
    word("dmat2", Foreign, (400, NEVER), (NEVER, 310)),
    word("dmat3", Foreign, (400, NEVER), (NEVER, 310)),
    word("dmat4", Foreign, (400, NEVER), (NEVER, 310)),
    word("dmat2x2", Foreign, (400, NEVER), (NEVER, 310)),
    word("dmat2x3", Foreign, (400, NEVER), (NEVER, 310)),
    word("dmat2x4", Foreign, (400, NEVER), (NEVER, 310)),
    word("dmat3x2", Foreign, (400, NEVER), (NEVER, 310)),
    word("dmat3x3", Foreign, (400, NEVER), (NEVER, 310)),
    word("dmat3x4", Foreign, (400, NEVER), (NEVER, 310)),
    word("dmat4x2", Foreign, (400, NEVER), (NEVER, 310)),
    word("dmat4x3", Foreign, (400, NEVER), (NEVER, 310)),
    word("dmat4x4", Foreign, (400, NEVER), (NEVER, 310)),
    word("patch", Foreign, (400, NEVER), (320, 300)),
    word("sample", Sample, (400, NEVER), (320, 300)).or(SHADER5),
    word("subroutine", Foreign, (400, NEVER), (NEVER, 300)),
    word("samplerCubeArray", Type, (400, NEVER), (320, 310)).or(CUBE_ARRAYS),
    word("samplerCubeArrayShadow", Type, (400, NEVER), (320, 310)).or(CUBE_ARRAYS),
    word("isamplerCubeArray", Type, (400, NEVER), (320, 310)).or(CUBE_ARRAYS),
    word("usamplerCubeArray", Type, (400, NEVER), (320, 310)).or(CUBE_ARRAYS),
    word("coherent", Foreign, (420, NEVER), (310, 300)),
    word("restrict", Foreign, (420, NEVER), (310, 300)),
    word("readonly", Foreign, (420, NEVER), (310, 300)),
    word("writeonly", Foreign, (420, NEVER), (310, 300)),
    word("atomic_uint", Foreign, (420, NEVER), (310, 300)),
    word("resource", Reserved, (NEVER, 420), (NEVER, 300)),
    word("image2DRect", Foreign, (420, NEVER), (NEVER, 310)),
    word("iimage2DRect", Foreign, (420, NEVER), (NEVER, 310)),
    word("uimage2DRect", Foreign, (420, NEVER), (NEVER, 310)),
    word("imageCubeArray", Foreign, (420, NEVER), (320, 310)),
    word("iimageCubeArray", Foreign, (420, NEVER), (320, 310)),
    word("uimageCubeArray", Foreign, (420, NEVER), (320, 310)),
    word("image2DMS", Foreign, (420, NEVER), (NEVER, 310)),
    word("iimage2DMS", Foreign, (420, NEVER), (NEVER, 310)),
    word("uimage2DMS", Foreign, (420, NEVER), (NEVER, 310)),
    word("image2DMSArray", Foreign, (420, NEVER), (NEVER, 310)),
    word("iimage2DMSArray", Foreign, (420, NEVER), (NEVER, 310)),
    word("uimage2DMSArray", Foreign, (420, NEVER), (NEVER, 310)),
    word("buffer", Foreign, (430, NEVER), (310, NEVER)),
    word("shared", Foreign, (430, NEVER), (310, NEVER)),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::Profile;
    use crate::source::Span;
    use crate::syntax::names::Names;

    #[test]
    fn rows_are_the_first_symbols() {
        let names = Names::with_keywords();
        assert_eq!(names.len(), TABLE.len(), "a word stands twice");
        for (index, row) in TABLE.iter().enumerate() {
            assert_eq!(names.get(row.spelling).map(|symbol| symbol.index()), Some(index));
        }
    }

    fn kind(spelling: &str, number: u16, profile: Profile) -> Option<TokenKind> {
        let version = Version { number, profile, span: Span::default() };
        let row = TABLE.iter().find(|row| row.spelling == spelling)?;
        Some(row.kind_in(version, Extensions::empty()))
    }

    #[test]
    fn words_of_1_50() {
        let core = |spelling| kind(spelling, 150, Profile::Core);
        assert_eq!(core("sampler2DRect"), Some(Type));
        assert_eq!(core("flat"), Some(Flat));
        assert_eq!(core("double"), Some(Reserved));
        assert_eq!(core("row_major"), Some(Reserved));
        assert_eq!(core("precise"), Some(Ident));
        let reserved = TABLE.iter().filter(|row| core(row.spelling) == Some(Reserved));
        assert_eq!(reserved.count(), 70);
    }

    #[test]
    fn a_word_changes_with_the_version() {
        let kinds = |spelling| [110, 130, 330, 420].map(|number| kind(spelling, number, Profile::Core));
        assert_eq!(kinds("switch"), [Some(Reserved), Some(Switch), Some(Switch), Some(Switch)]);
        assert_eq!(kinds("precise"), [Some(Ident), Some(Ident), Some(Ident), Some(Precise)]);
        assert_eq!(kinds("image2D"), [Some(Ident), Some(Reserved), Some(Reserved), Some(Foreign)]);
        let es = |spelling| [100, 300, 310].map(|number| kind(spelling, number, Profile::Es));
        assert_eq!(es("attribute"), [Some(Attribute), Some(Reserved), Some(Reserved)]);
        assert_eq!(es("flat"), [Some(Reserved), Some(Flat), Some(Flat)]);
        assert_eq!(es("texture"), [None; 3]);
        assert_eq!(es("dmat2"), [Some(Ident), Some(Ident), Some(Reserved)]);
        assert_eq!(es("packed"), [Some(Reserved), Some(Ident), Some(Ident)]);
        let late = |spelling| [420, 430, 440].map(|number| kind(spelling, number, Profile::Core));
        assert_eq!(late("packed"), [Some(Reserved), Some(Reserved), Some(Ident)]);
        assert_eq!(late("image1DShadow"), [Some(Ident); 3]);
    }

    #[test]
    fn an_extension_makes_keywords() {
        let version = Version { number: 120, profile: Profile::Core, span: Span::default() };
        let row = TABLE.iter().find(|row| row.spelling == "sampler2DArray").copied();
        let row = row.expect("the table has it");
        assert_eq!(row.kind_in(version, Extensions::empty()), Ident);
        assert_eq!(row.kind_in(version, Extensions::TEXTURE_ARRAY), Type);
    }
}

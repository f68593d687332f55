//! The words of the language as data (GLSL 1.50 §3.6): in which versions each is a keyword and in which it is only
//! reserved.
//!
//! *Holds:* row *n* is symbol *n* of [`Names::with_keywords`](super::names::Names::with_keywords).
//! Names that begin with `gl_`, built-in functions and the names inside `layout(..)` are not keywords; they are not
//! here.

use super::token::TokenKind::{self, *};

/// A word of the language.
#[derive(Clone, Copy, Debug)]
pub struct Keyword {
    /// The spelling.
    pub spelling: &'static str,
    /// The token kind of the keyword.
    pub kind: TokenKind,
    /// The first version in which it is a keyword, or [`NEVER`].
    pub keyword_since: u16,
    /// The first version in which using it is an error, or [`NEVER`].
    pub reserved_since: u16,
}

/// A version later than all others.
pub const NEVER: u16 = u16::MAX;

const fn word(spelling: &'static str, kind: TokenKind, keyword_since: u16, reserved_since: u16) -> Keyword {
    Keyword { spelling, kind, keyword_since, reserved_since }
}

impl Keyword {
    /// The token kind of the word in a version.
    pub fn kind_in(&self, version: u16) -> TokenKind {
        if version >= self.keyword_since {
            self.kind
        } else if version >= self.reserved_since {
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
    pub fn of(word: &str, version: u16) -> Option<Self> {
        if word.starts_with("gl_") {
            return Some(Self::Builtin);
        }
        match TABLE.iter().find(|row| row.spelling == word)?.kind_in(version) {
            Type | Void => Some(Self::Type),
            True | False => Some(Self::Constant),
            Ident | Reserved => None,
            _ => Some(Self::Keyword),
        }
    }
}

/// The token kind of each word of the table in a version, by symbol.
pub(super) fn kinds_in(version: u16) -> Vec<TokenKind> {
    TABLE.iter().map(|row| row.kind_in(version)).collect()
}

/// All words that are keywords or reserved in some version.
pub static TABLE: &[Keyword] = &[
    word("float", Type, 110, NEVER),
    word("int", Type, 110, NEVER),
    word("bool", Type, 110, NEVER),
    word("mat2", Type, 110, NEVER),
    word("mat3", Type, 110, NEVER),
    word("mat4", Type, 110, NEVER),
    word("mat2x2", Type, 120, NEVER),
    word("mat2x3", Type, 120, NEVER),
    word("mat2x4", Type, 120, NEVER),
    word("mat3x2", Type, 120, NEVER),
    word("mat3x3", Type, 120, NEVER),
    word("mat3x4", Type, 120, NEVER),
    word("mat4x2", Type, 120, NEVER),
    word("mat4x3", Type, 120, NEVER),
    word("mat4x4", Type, 120, NEVER),
    word("vec2", Type, 110, NEVER),
    word("vec3", Type, 110, NEVER),
    word("vec4", Type, 110, NEVER),
    word("ivec2", Type, 110, NEVER),
    word("ivec3", Type, 110, NEVER),
    word("ivec4", Type, 110, NEVER),
    word("bvec2", Type, 110, NEVER),
    word("bvec3", Type, 110, NEVER),
    word("bvec4", Type, 110, NEVER),
    word("uint", Type, 130, NEVER),
    word("uvec2", Type, 130, NEVER),
    word("uvec3", Type, 130, NEVER),
    word("uvec4", Type, 130, NEVER),
    word("sampler1D", Type, 110, NEVER),
    word("sampler2D", Type, 110, NEVER),
    word("sampler3D", Type, 110, NEVER),
    word("samplerCube", Type, 110, NEVER),
    word("sampler1DShadow", Type, 110, NEVER),
    word("sampler2DShadow", Type, 110, NEVER),
    word("samplerCubeShadow", Type, 130, NEVER),
    word("sampler1DArray", Type, 130, NEVER),
    word("sampler2DArray", Type, 130, NEVER),
    word("sampler1DArrayShadow", Type, 130, NEVER),
    word("sampler2DArrayShadow", Type, 130, NEVER),
    word("isampler1D", Type, 130, NEVER),
    word("isampler2D", Type, 130, NEVER),
    word("isampler3D", Type, 130, NEVER),
    word("isamplerCube", Type, 130, NEVER),
    word("isampler1DArray", Type, 130, NEVER),
    word("isampler2DArray", Type, 130, NEVER),
    word("usampler1D", Type, 130, NEVER),
    word("usampler2D", Type, 130, NEVER),
    word("usampler3D", Type, 130, NEVER),
    word("usamplerCube", Type, 130, NEVER),
    word("usampler1DArray", Type, 130, NEVER),
    word("usampler2DArray", Type, 130, NEVER),
    word("sampler2DRect", Type, 140, 110),
    word("sampler2DRectShadow", Type, 140, 110),
    word("isampler2DRect", Type, 140, 130),
    word("usampler2DRect", Type, 140, 130),
    word("samplerBuffer", Type, 140, 130),
    word("isamplerBuffer", Type, 140, 130),
    word("usamplerBuffer", Type, 140, 130),
    word("sampler2DMS", Type, 150, NEVER),
    word("isampler2DMS", Type, 150, NEVER),
    word("usampler2DMS", Type, 150, NEVER),
    word("sampler2DMSArray", Type, 150, NEVER),
    word("isampler2DMSArray", Type, 150, NEVER),
    word("usampler2DMSArray", Type, 150, NEVER),
    word("attribute", Attribute, 110, NEVER),
    word("const", Const, 110, NEVER),
    word("uniform", Uniform, 110, NEVER),
    word("varying", Varying, 110, NEVER),
    word("layout", Layout, 140, NEVER),
    word("centroid", Centroid, 120, NEVER),
    word("flat", Flat, 130, NEVER),
    word("smooth", Smooth, 130, NEVER),
    word("noperspective", Noperspective, 130, NEVER),
    word("break", Break, 110, NEVER),
    word("continue", Continue, 110, NEVER),
    word("do", Do, 110, NEVER),
    word("for", For, 110, NEVER),
    word("while", While, 110, NEVER),
    word("switch", Switch, 130, 110),
    word("case", Case, 130, NEVER),
    word("default", Default, 130, 110),
    word("if", If, 110, NEVER),
    word("else", Else, 110, NEVER),
    word("in", In, 110, NEVER),
    word("out", Out, 110, NEVER),
    word("inout", Inout, 110, NEVER),
    word("void", Void, 110, NEVER),
    word("true", True, 110, NEVER),
    word("false", False, 110, NEVER),
    word("invariant", Invariant, 120, NEVER),
    word("discard", Discard, 110, NEVER),
    word("return", Return, 110, NEVER),
    word("lowp", Lowp, 130, 120),
    word("mediump", Mediump, 130, 120),
    word("highp", Highp, 130, 120),
    word("precision", Precision, 130, 120),
    word("struct", Struct, 110, NEVER),
    word("common", Reserved, NEVER, 140),
    word("partition", Reserved, NEVER, 140),
    word("active", Reserved, NEVER, 140),
    word("asm", Reserved, NEVER, 110),
    word("class", Reserved, NEVER, 110),
    word("union", Reserved, NEVER, 110),
    word("enum", Reserved, NEVER, 110),
    word("typedef", Reserved, NEVER, 110),
    word("template", Reserved, NEVER, 110),
    word("this", Reserved, NEVER, 110),
    word("packed", Reserved, NEVER, 110),
    word("goto", Reserved, NEVER, 110),
    word("inline", Reserved, NEVER, 110),
    word("noinline", Reserved, NEVER, 110),
    word("volatile", Reserved, NEVER, 110),
    word("public", Reserved, NEVER, 110),
    word("static", Reserved, NEVER, 110),
    word("extern", Reserved, NEVER, 110),
    word("external", Reserved, NEVER, 110),
    word("interface", Reserved, NEVER, 110),
    word("long", Reserved, NEVER, 110),
    word("short", Reserved, NEVER, 110),
    word("double", Type, 400, 110),
    word("half", Reserved, NEVER, 110),
    word("fixed", Reserved, NEVER, 110),
    word("unsigned", Reserved, NEVER, 110),
    word("superp", Reserved, NEVER, 130),
    word("input", Reserved, NEVER, 110),
    word("output", Reserved, NEVER, 110),
    word("hvec2", Reserved, NEVER, 110),
    word("hvec3", Reserved, NEVER, 110),
    word("hvec4", Reserved, NEVER, 110),
    word("dvec2", Type, 400, 110),
    word("dvec3", Type, 400, 110),
    word("dvec4", Type, 400, 110),
    word("fvec2", Reserved, NEVER, 110),
    word("fvec3", Reserved, NEVER, 110),
    word("fvec4", Reserved, NEVER, 110),
    word("sampler3DRect", Reserved, NEVER, 110),
    word("filter", Reserved, NEVER, 130),
    word("image1D", Type, 420, 130),
    word("image2D", Type, 420, 130),
    word("image3D", Type, 420, 130),
    word("imageCube", Type, 420, 130),
    word("iimage1D", Type, 420, 130),
    word("iimage2D", Type, 420, 130),
    word("iimage3D", Type, 420, 130),
    word("iimageCube", Type, 420, 130),
    word("uimage1D", Type, 420, 130),
    word("uimage2D", Type, 420, 130),
    word("uimage3D", Type, 420, 130),
    word("uimageCube", Type, 420, 130),
    word("image1DArray", Type, 420, 130),
    word("image2DArray", Type, 420, 130),
    word("iimage1DArray", Type, 420, 130),
    word("iimage2DArray", Type, 420, 130),
    word("uimage1DArray", Type, 420, 130),
    word("uimage2DArray", Type, 420, 130),
    word("image1DShadow", Reserved, NEVER, 130),
    word("image2DShadow", Reserved, NEVER, 130),
    word("image1DArrayShadow", Reserved, NEVER, 130),
    word("image2DArrayShadow", Reserved, NEVER, 130),
    word("imageBuffer", Type, 420, 130),
    word("iimageBuffer", Type, 420, 130),
    word("uimageBuffer", Type, 420, 130),
    word("sizeof", Reserved, NEVER, 110),
    word("cast", Reserved, NEVER, 110),
    word("namespace", Reserved, NEVER, 110),
    word("using", Reserved, NEVER, 110),
    word("row_major", Reserved, NEVER, 130),
    word("precise", Precise, 400, NEVER),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::names::Names;

    #[test]
    fn rows_are_the_first_symbols() {
        let names = Names::with_keywords();
        assert_eq!(names.len(), TABLE.len(), "a word stands twice");
        for (index, row) in TABLE.iter().enumerate() {
            assert_eq!(names.get(row.spelling).map(|symbol| symbol.index()), Some(index));
        }
    }

    #[test]
    fn words_of_1_50() {
        let kind = |spelling| TABLE.iter().find(|row| row.spelling == spelling).map(|row| row.kind_in(150));
        assert_eq!(kind("sampler2DRect"), Some(Type));
        assert_eq!(kind("flat"), Some(Flat));
        assert_eq!(kind("double"), Some(Reserved));
        assert_eq!(kind("row_major"), Some(Reserved));
        assert_eq!(kind("precise"), Some(Ident));
        assert_eq!(TABLE.iter().filter(|row| row.kind_in(150) == Reserved).count(), 70);
    }
}

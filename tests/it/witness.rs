//! An independent opinion on syntax: glsl-lang's parser for the 4.60 grammar accepts what this one accepts.

use crate::support::shaders_under;
use glsl_lang::ast::TranslationUnit;
use glsl_lang::parse::DefaultParse;

/// Valid sources that it rejects, and why it is wrong about them.
static REFUSED: &[(&str, &str)] = &[
    ("fixtures/valid/names/scopes.vert", "a variable may hide a struct's name (§4.2.2)"),
    ("fixtures/valid/preprocess/byte_order_mark.vert", "a byte order mark before the text is forgiven"),
    ("fixtures/valid/preprocess/extension_warn.frag", "`warn` asks for warnings, not for errors (§3.3)"),
    ("fixtures/valid/preprocess/kind.vert", "a pragma that is not understood is ignored (§3.3)"),
    ("fixtures/valid/preprocess/lines.vert", "behind `#line n` comes line n + 1 before 3.30 (§3.3)"),
    ("fixtures/valid/qualifiers/depth_range_type.frag", "`gl_DepthRangeParameters` is a type (§7.5)"),
    ("fixtures/valid/qualifiers/invariant_inputs.frag", "inputs may be `invariant` before 4.20 (4.10 §4.6.1)"),
    ("fixtures/valid/qualifiers/invariant_members.vert", "a block's members may be `invariant` (§4.3.7)"),
    ("fixtures/valid/qualifiers/places.vert", "`invariant` takes a list of names (§4.6.1)"),
    ("fixtures/valid/syntax/forgiven.vert", "drivers take literals past the range; here they are warned of"),
];

#[test]
fn another_parser_accepts_the_valid_fixtures() {
    let mut wrong = Vec::new();
    let mut seen = 0;
    for shader in ["fixtures/valid", "fixtures/programs"].iter().flat_map(|folder| shaders_under(folder)) {
        seen += 1;
        let excused = REFUSED.iter().any(|row| shader.name == row.0);
        match TranslationUnit::parse(&shader.text) {
            Ok(_) if excused => wrong.push(format!("{}: accepted; take it from the list", shader.name)),
            Err(error) if !excused => wrong.push(format!("{}: {error}", shader.name)),
            _ => {}
        }
    }
    assert!(seen > 20, "the fixtures are not where they are looked for");
    assert!(wrong.is_empty(), "{wrong:#?}");
}

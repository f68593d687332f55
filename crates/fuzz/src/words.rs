//! [`dictionary`]: the words that a fuzzer puts into inputs.
//!
//! *In:* glisten's tables of keywords, built-in functions, variables, constants and extensions. *Out:* a dictionary as libFuzzer reads
//! it, one quoted word a line, with some texts that reach limits.

use glisten_front::builtin::constants::CONSTANTS;
use glisten_front::builtin::{BuiltinFunction, BuiltinVariable};
use glisten_front::syntax::keywords::TABLE;

/// Texts that reach limits, and words that no table has.
const OTHERS: &[&str] = &[
    "-1",
    "0",
    "1u",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "1e39",
    "1e-50",
    "nan",
    "inf",
    "[2147483647]",
    "[65536][65536]",
    "[]",
    ".xxxx",
    ".length()",
    "##",
    "\\\n",
    "/*",
    "*/",
    "\n#if 1\n",
    "\n#elif 1 / 0\n",
    "\n#else\n",
    "\n#endif\n",
    "\n#define f(x) x f(x) x\n",
    "\n#undef f\n",
    "\n#line 2147483647\n",
    "\n#include \"x\"\n",
    "\n#version 110\n",
    "\n#version 150\n",
    "\n#version 300 es\n",
    "\n#version 460\n",
    "\n#extension all : warn\n",
    "layout(location = 4294967295) ",
    "layout(std140) ",
    "layout(binding = 1) ",
    "layout(set = 1, binding = 2) ",
    "for (;;) ",
    "while (true) ",
    "struct S { S s; };",
    "float f(float x) { return f(x); }",
    "switch (1) { case 1: }",
    "float[2](1.0, 2.0)",
    "void main() {}",
    "\n//# vertex\n",
    "\n//# geometry\n",
    "\n//# fragment\n",
    "\n//# scene\n",
    "[[draw]]",
    "[draw.uniforms]",
    "[draw.attributes]",
    "[draw.textures]",
    "[framebuffer]",
    "primitive = \"triangles\"",
    "vertex_count = 3",
    "instances = 4294967295",
    "indices = [4294967295]",
];

/// The dictionary.
pub fn dictionary() -> String {
    let keywords = TABLE.iter().map(|row| row.spelling);
    let functions = BuiltinFunction::ALL.iter().map(|row| row.name());
    let variables = BuiltinVariable::ALL.iter().map(|row| row.name());
    let constants = CONSTANTS.iter().map(|row| row.name);
    let all = keywords.chain(functions).chain(variables).chain(constants).chain(OTHERS.iter().copied());
    let mut lines: Vec<String> = all.map(quoted).collect();
    lines.sort();
    lines.dedup();
    lines.join("\n") + "\n"
}

/// A word in quotes; what is no plain character by its number.
fn quoted(word: &str) -> String {
    let letter = |byte: u8| match byte {
        b'"' | b'\\' => format!("\\{}", char::from(byte)),
        b' '..=b'~' => char::from(byte).to_string(),
        _ => format!("\\x{byte:02x}"),
    };
    format!("\"{}\"", word.bytes().map(letter).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_all_tables_are_there() {
        let words = dictionary();
        for word in
            ["\"smoothstep\"", "\"gl_FragCoord\"", "\"uniform\"", "\"gl_MaxDrawBuffers\"", "\"\\x0a#else\\x0a\""]
        {
            assert!(words.lines().any(|line| line == word), "{word}");
        }
    }
}

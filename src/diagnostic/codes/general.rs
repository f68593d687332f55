//! Limits, what is not supported yet, and slips of glisten's own.

use super::Example::{Fragment, None};

codes! {
    NOT_SUPPORTED_YET = "E0001" "not-supported-yet" Error ""
        "The source uses a construct that glisten knows of and cannot carry yet. The message names it. Nothing is \
         translated rather than translated wrongly."
        bad None, good None;
    INTERNAL = "E0002" "internal-error" Error ""
        "glisten contradicted itself. This is a fault of glisten and not of the source; please report it with the source."
        bad None, good None;
    TOO_DEEP = "E0003" "nesting-too-deep" Error ""
        "Expressions, blocks and types may be nested 256 levels deep. Long chains (`a + b + c`, `else if`) are not \
         nesting and may be far longer."
        bad None, good Fragment("out vec4 c; void main() { c = vec4(((1.0))); }");
    TOO_LARGE = "E0004" "source-too-large" Error ""
        "A source may have 8 MiB after its includes."
        bad None, good None;
}

//! The sections of the GLSL 1.50 specification, and why some have no code.

/// A section.
pub(crate) struct Section {
    pub(crate) number: &'static str,
    pub(crate) title: &'static str,
    /// Why no code cites it; empty if a code should.
    pub(crate) note: &'static str,
}

/// Rules that depend on the version and have a code of their own, not `E0617`.
pub(crate) static OWN_CODES: &[(&str, &str)] = &[
    ("a joined line", "W0101"),
    ("attributes that share a location", "E0711"),
    ("another precision of a member in each stage", "E0732"),
    ("the rule for names in an interface", "E0734"),
    ("`smooth` in one stage alone", "E0704"),
    ("an array of arrays", "E0412"),
    ("an initializer list", "E0214"),
    ("a `const` whose value is not a constant expression", "E0408"),
    ("a texture offset that is not constant", "E0408"),
    ("the implicit conversion to `uint`", "E0401"),
    ("qualifiers in this order", "E0602"),
    ("a second `layout`", "E0601"),
    ("the rule for a second `location`", "E0601"),
    ("the rule for `invariant` with a layout", "E0603"),
    ("a swizzle of a scalar", "E0306"),
    ("the length of a vector", "E0416"),
    ("a converted `return` value", "W0501"),
    ("one name space for functions and variables", "E0302"),
    ("prototypes at global scope alone", "E0511"),
    ("one scope for parameters and body", "E0302"),
    ("no comma in a constant expression", "E0408"),
    ("an input that the stage before does not write", "E0702"),
    ("the pragma `invariant(all)` in a fragment shader", "E0616"),
];

macro_rules! sections {
    ($($number:literal $title:literal $note:literal;)*) => {
        /// All sections with rules or definitions, in order.
        pub(crate) static SECTIONS: &[Section] =
            &[$(Section { number: $number, title: $title, note: $note }),*];
    };
}

sections! {
    "§2.1" "Vertex Processor" "an overview without rules";
    "§2.2" "Geometry Processor" "an overview without rules";
    "§2.3" "Fragment Processor" "an overview without rules";
    "§3.1" "Character Set" "";
    "§3.2" "Source Strings" "several strings are concatenated by the host; lines and columns are tested";
    "§3.3" "Preprocessor" "";
    "§3.4" "Comments" "";
    "§3.5" "Tokens" "the lexer's tests; what is no token is `E0103`";
    "§3.6" "Keywords" "";
    "§3.7" "Identifiers" "";
    "§3.8" "Static Use" "a definition, which the rules for unused inputs and for links use";
    "§4.1" "Basic Types" "";
    "§4.1.1" "Void" "";
    "§4.1.2" "Booleans" "no rule of its own; conditions are checked in §6.2 and §6.3";
    "§4.1.3" "Integers" "";
    "§4.1.4" "Floats" "";
    "§4.1.5" "Vectors" "a list of types";
    "§4.1.6" "Matrices" "a list of types";
    "§4.1.7" "Samplers" "";
    "§4.1.8" "Structures" "";
    "§4.1.9" "Arrays" "";
    "§4.1.10" "Implicit Conversions" "";
    "§4.2" "Scoping" "";
    "§4.3" "Storage Qualifiers" "";
    "§4.3.1" "Default Storage Qualifier" "no rule that a program can break";
    "§4.3.2" "Constant Qualifier" "";
    "§4.3.3" "Constant Expressions" "";
    "§4.3.4" "Inputs" "";
    "§4.3.5" "Uniform" "";
    "§4.3.6" "Outputs" "";
    "§4.3.7" "Interface Blocks" "";
    "§4.3.8" "Layout Qualifiers" "";
    "§4.3.8.1" "Input Layout Qualifiers" "";
    "§4.3.8.2" "Output Layout Qualifiers" "";
    "§4.3.8.3" "Uniform Block Layout Qualifiers" "by the codes of §4.3.7 and §4.3.8; offsets are compared with a driver's";
    "§4.3.9" "Interpolation" "";
    "§4.3.9.1" "Redeclaring Built-in Interpolation Variables in the Compatibility Profile" "names of the fixed-function pipeline ([versions](versions.md))";
    "§4.4" "Parameter Qualifiers" "";
    "§4.5" "Precision and Precision Qualifiers" "";
    "§4.5.1" "Range and Precision" "the reference's numbers, and their envelopes";
    "§4.5.2" "Precision Qualifiers" "they have no effect";
    "§4.5.3" "Default Precision Qualifiers" "they have no effect";
    "§4.5.4" "Available Precision Qualifiers" "all are, and have no effect";
    "§4.6" "Variance and the Invariant Qualifier" "";
    "§4.6.1" "The Invariant Qualifier" "";
    "§4.6.2" "Invariance of Constant Expressions" "constants are folded in one way, for all stages and targets";
    "§4.7" "Order of Qualification" "";
    "§5.1" "Operators" "precedence is the grammar's; `fixtures/valid` has each operator";
    "§5.2" "Array Operations" "by the codes of §4.1.9 and §5.7";
    "§5.3" "Function Calls" "by the codes of §6.1";
    "§5.4" "Constructors" "";
    "§5.4.1" "Conversion and Scalar Constructors" "by the codes of §5.4";
    "§5.4.2" "Vector and Matrix Constructors" "";
    "§5.4.3" "Structure Constructors" "by the codes of §5.4";
    "§5.4.4" "Array Constructors" "by the codes of §5.4";
    "§5.5" "Vector Components" "";
    "§5.6" "Matrix Components" "";
    "§5.7" "Structure and Array Operations" "";
    "§5.8" "Assignments" "";
    "§5.9" "Expressions" "";
    "§5.10" "Vector and Matrix Operations" "what no operator takes is an error of §5.9; values are compared with wide numbers";
    "§6.1" "Function Definitions" "";
    "§6.1.1" "Function Calling Conventions" "";
    "§6.2" "Selection" "";
    "§6.3" "Iteration" "";
    "§6.4" "Jumps" "";
    "§7.1" "Vertex and Geometry Shader Special Variables" "";
    "§7.1.1" "Compatibility Profile Vertex and Geometry Shader Special Variables" "names of the fixed-function pipeline ([versions](versions.md))";
    "§7.2" "Fragment Shader Special Variables" "";
    "§7.3" "Compatibility Profile Vertex Shader Built-In Inputs" "names of the fixed-function pipeline ([versions](versions.md))";
    "§7.4" "Built-In Constants" "the values are the smallest that the specification allows, or larger";
    "§7.4.1" "Compatibility Profile Built-In Constants" "names of the fixed-function pipeline ([versions](versions.md))";
    "§7.5" "Built-In Uniform State" "";
    "§7.5.1" "Compatibility Profile State" "names of the fixed-function pipeline ([versions](versions.md))";
    "§7.6" "Compatibility Profile Vertex and Fragment Interface" "names of the fixed-function pipeline ([versions](versions.md))";
    "§8.1" "Angle and Trigonometry Functions" "";
    "§8.2" "Exponential Functions" "";
    "§8.3" "Common Functions" "";
    "§8.4" "Geometric Functions" "";
    "§8.5" "Matrix Functions" "";
    "§8.6" "Vector Relational Functions" "";
    "§8.7" "Texture Lookup Functions" "";
    "§8.8" "Fragment Processing Functions" "";
    "§8.9" "Noise Functions" "";
    "§8.10" "Geometry Shader Functions" "";
    "§9" "Shading Language Grammar" "the parser accepts it; what it rejects are the codes `E02xx`";
}

//! Rewrites what naga writes in HLSL and not every compiler of HLSL reads.
//!
//! | naga writes | here | superfluous once |
//! | --- | --- | --- |
//! | samplers from a heap, through a buffer of indices that only wgpu binds | variables with registers | naga has an option for that |
//! | `(float[3])0` | a list of zeros | glslang reads casts to arrays |
//! | calls of constructing functions in initializers of globals | lists, with zeros for what pads a struct | glslang links them (it finds a recursion) |
//! | one `float` for all clip distances | vectors of up to four | naga writes built-in arrays |
//! | functions that set a part of a matrix of two rows in a struct, and get the struct by value | `inout` parameters | naga writes them |
//! | such a matrix as one number of a list for a struct, which has its columns | the columns | glslang reads it |
//! | `int2(int3(..))` as the offset of a lookup in a 3D texture | `int3(int3(..))` | naga counts its components |
//!
//! *In:* HLSL as naga writes it, one declaration per line. *Out:* the same program.

use std::collections::BTreeMap;
use std::slice::Iter;

/// The members of each struct, as HLSL declares them: whether a member only pads.
type Structs<'a> = BTreeMap<&'a str, Vec<bool>>;

/// The text with all repairs.
pub(super) fn repaired(text: &str) -> String {
    let structs = structs(text);
    let mut result = String::with_capacity(text.len());
    for line in text.lines() {
        if is_of_heap(line) {
            continue;
        }
        let line = line.replace("int2(int3(", "int3(int3(");
        let repaired =
            plain_sampler(&line).or_else(|| setter(&line)).or_else(|| zeros(&line)).or_else(|| listed(&line, &structs));
        result.push_str(&repaired.unwrap_or(line));
        result.push('\n');
    }
    result
}

fn is_of_heap(line: &str) -> bool {
    line.contains("SamplerHeap[2048]: register(")
        || (line.starts_with("StructuredBuffer<uint> nagaGroup") && line.contains("SamplerIndexArray"))
}

/// `static const SamplerState s = nagaSamplerHeap[nagaGroup1SamplerIndexArray[2]];` as `SamplerState s : register(s2);`.
fn plain_sampler(line: &str) -> Option<String> {
    let (declaration, heap) = line.strip_prefix("static const ")?.split_once(" = ")?;
    let index = heap.strip_prefix("nagaSamplerHeap[").or_else(|| heap.strip_prefix("nagaComparisonSamplerHeap["))?;
    let number = index.split_once('[')?.1.strip_suffix("]];")?;
    Some(format!("{declaration} : register(s{number});"))
}

/// `void SetMatmOnS(S obj, float2x2 mat) {` as `void SetMatmOnS(inout S obj, float2x2 mat) {`.
fn setter(line: &str) -> Option<String> {
    let (name, parameters) = line.strip_prefix("void ")?.split_once('(')?;
    let (first, _) = parameters.split_once(", ")?;
    let of_struct = name.starts_with("SetMat") && name.contains("On") && first.ends_with(" obj");
    let of_matrix = name.starts_with("__set_") && first.starts_with("__mat");
    ((of_struct || of_matrix) && line.ends_with('{')).then(|| format!("void {name}(inout {parameters}"))
}

/// `float a[3] = (float[3])0;` as `float a[3] = { (float)0, (float)0, (float)0 };`, also behind a `return`.
fn zeros(line: &str) -> Option<String> {
    let cast = line.trim_end().strip_suffix(")0;")?;
    let (before, ty) = cast.rsplit_once('(')?;
    let (element, sizes) = ty.split_once('[')?;
    let mut count: usize = 1;
    for size in sizes.trim_end_matches(']').split("][") {
        count = count.checked_mul(size.parse().ok()?)?;
    }
    let list = vec![format!("({element})0"); count].join(", ");
    let indent = &before[..before.len() - before.trim_start().len()];
    match before.trim() {
        "return" => Some(format!("{indent}{element} zero[{sizes} = {{ {list} }};\n{indent}return zero;")),
        _ => Some(format!("{before}{{ {list} }};")),
    }
}

/// The structs of a text.
fn structs(text: &str) -> Structs<'_> {
    let mut structs = Structs::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let Some(name) = line.strip_prefix("struct ").and_then(|rest| rest.strip_suffix(" {")) else { continue };
        let members = lines.by_ref().take_while(|member| *member != "};");
        let pads = |member: &str| {
            member.trim_start().starts_with("int _pad") || member.trim_start().starts_with("int _end_pad")
        };
        structs.insert(name, members.map(pads).collect());
    }
    structs
}

/// An open parenthesis in the initializer of a global.
enum Open<'a> {
    /// Of a struct, for which it became a brace, with the members to come: whether each only pads.
    Struct(Iter<'a, bool>),
    /// Of an array, for which it became a brace.
    Array,
    /// Of a matrix of two rows in a struct, whose columns are members.
    Columns,
    /// It stays.
    Call,
}

impl<'a> Open<'a> {
    /// The kind of the parenthesis after `word`, in the one that is `around`.
    fn by(word: &str, structs: &'a Structs<'_>, around: Option<&Open<'_>>) -> Self {
        if let Some(name) = word.strip_prefix("Construct") {
            return structs.get(name).map_or(Self::Array, |members| Self::Struct(members.iter()));
        }
        let in_struct = matches!(around, Some(Open::Struct(_)));
        if in_struct && matches!(word, "float2x2" | "float3x2" | "float4x2") { Self::Columns } else { Self::Call }
    }

    fn sign(&self) -> &'static str {
        match self {
            Self::Struct(_) | Self::Array => "{ ",
            Self::Columns => "",
            Self::Call => "(",
        }
    }
}

/// The initializer of a global as a list: `static float a[2] = Constructarray2_float_(1.0, 2.0);`. A list has a number for each scalar of
/// the struct, also for those that pad it.
fn listed(line: &str, structs: &Structs<'_>) -> Option<String> {
    let (declaration, value) = line.strip_prefix("static ").and_then(|rest| rest.split_once(" = "))?;
    if !value.contains("Construct") {
        return None;
    }
    let mut list = String::with_capacity(value.len());
    let mut open: Vec<Open<'_>> = Vec::new();
    let mut word = String::new();
    for character in value.chars() {
        if character.is_ascii_alphanumeric() || character == '_' {
            word.push(character);
            continue;
        }
        let opened = Open::by(&word, structs, open.last());
        if character != '(' || matches!(opened, Open::Call) {
            list.push_str(&word);
        }
        word.clear();
        match character {
            '(' => {
                list.push_str(opened.sign());
                open.push(opened);
            }
            ')' => match open.pop()? {
                Open::Struct(members) => {
                    members.for_each(|_| list.push_str(", 0"));
                    list.push_str(" }");
                }
                Open::Array => list.push_str(" }"),
                Open::Columns => {}
                Open::Call => list.push(')'),
            },
            other => list.push(other),
        }
        if matches!(character, '(' | ',')
            && let Some(Open::Struct(members)) = open.last_mut()
        {
            // Up to the next member that the call has an argument for.
            let pads = members.by_ref().take_while(|pads| **pads).count();
            let gap = if character == ',' { " 0," } else { "0, " };
            list.push_str(&gap.repeat(pads));
        }
    }
    Some(format!("static {declaration} = {list}{word}"))
}

/// The text with `count` clip distances. They are packed into vectors, since Direct3D has two elements for them.
pub(super) fn with_clip_distances(text: &str, count: u32) -> String {
    const SEMANTIC: &str = " : SV_ClipDistance;";
    // The struct that the function itself fills has the array.
    let mut own = text.lines().filter_map(|line| line.strip_suffix(SEMANTIC)?.split_whitespace().last());
    let Some(name) = own.find(|name| !name.ends_with(']')) else {
        return text.to_owned();
    };
    let declared = format!("float {name}{SEMANTIC}");
    let vectors: Vec<(u32, u32)> = (0..count).step_by(4).map(|first| (first, (count - first).min(4))).collect();
    let ty = |size| if size == 1 { "float".to_owned() } else { format!("float{size}") };
    let mut result = String::with_capacity(text.len());
    for line in text.lines() {
        if let Some(indent) = line.strip_suffix(declared.as_str()) {
            for (index, (_, size)) in vectors.iter().enumerate() {
                let name = if index == 0 { name.to_owned() } else { format!("{name}_{index}") };
                result.push_str(&format!("{indent}{} {name} : SV_ClipDistance{index};\n", ty(*size)));
            }
            continue;
        }
        match line.rsplit_once(&format!(".{name} }};")).filter(|_| line.trim_start().starts_with("const ")) {
            Some((before, after)) => {
                let (before, value) = before.rsplit_once([' ', ',']).unwrap_or(("", before));
                let parts = vectors.iter().map(|(first, size)| {
                    let parts: Vec<String> = (*first..first + size).map(|at| format!("{value}.{name}[{at}]")).collect();
                    if *size == 1 { parts.concat() } else { format!("{}({})", ty(*size), parts.join(", ")) }
                });
                result.push_str(&format!("{before} {} }};{after}\n", parts.collect::<Vec<_>>().join(", ")));
            }
            None => {
                result.push_str(line);
                result.push('\n');
            }
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::{repaired, with_clip_distances};

    #[test]
    fn samplers_have_registers() {
        let text = "Texture2D<float4> t : register(t0);\nSamplerState nagaSamplerHeap[2048]: register(s0, space0);\n\
                    SamplerComparisonState nagaComparisonSamplerHeap[2048]: register(s0, space1);\n\
                    StructuredBuffer<uint> nagaGroup1SamplerIndexArray : register(t0, space0);\n\
                    static const SamplerState s = nagaSamplerHeap[nagaGroup1SamplerIndexArray[3]];\n\
                    static const SamplerComparisonState c = nagaComparisonSamplerHeap[nagaGroup1SamplerIndexArray[4]];\n";
        let plain = "Texture2D<float4> t : register(t0);\nSamplerState s : register(s3);\n\
                     SamplerComparisonState c : register(s4);\n";
        assert_eq!(repaired(text), plain);
    }

    #[test]
    fn arrays_are_lists() {
        assert_eq!(repaired("    int a[2] = (int[2])0;\n"), "    int a[2] = { (int)0, (int)0 };\n");
        assert_eq!(repaired("    return (S[1])0;\n"), "    S zero[1] = { (S)0 };\n    return zero;\n");
        assert_eq!(repaired("    float4 a = (float4)0;\n"), "    float4 a = (float4)0;\n");
        let text = "static S a[2] = Constructarray2_S_(ConstructS_((1.0 + 2.0), float2(3.0, 4.0)), b);\n";
        assert_eq!(repaired(text), "static S a[2] = { { (1.0 + 2.0), float2(3.0, 4.0) }, b };\n");
        let declared = "struct S_ {\n    float a;\n    int _pad1_0;\n    float2 b;\n    int _end_pad_0;\n    int _end_pad_1;\n};\n";
        let padded = "static S_ a[2] = { { (1.0 + 2.0), 0, float2(3.0, 4.0), 0, 0 }, b };\n";
        assert_eq!(
            repaired(&format!("{declared}{}", text.replace("static S ", "static S_ "))),
            format!("{declared}{padded}")
        );
    }

    #[test]
    fn what_sets_a_matrix_of_two_rows_gets_the_struct() {
        let text = "void SetMatmOnS(S obj, float2x2 mat) {\nvoid SetMatVecmOnS(S obj, float2 vec, uint mat_idx) {\n\
                    void __set_el_of_mat2x2_f32(__mat2x2_f32 mat, uint idx, uint vec_idx, float value) {\nvoid SetMatter(float obj) {\n";
        let inout = "void SetMatmOnS(inout S obj, float2x2 mat) {\nvoid SetMatVecmOnS(inout S obj, float2 vec, uint mat_idx) {\n\
                     void __set_el_of_mat2x2_f32(inout __mat2x2_f32 mat, uint idx, uint vec_idx, float value) {\nvoid SetMatter(float obj) {\n";
        assert_eq!(repaired(text), inout);
        let declared = "struct S {\n    float a;\n    int _pad1_0;\n    float2 m_0; float2 m_1;\n};\n";
        let global = "static S s0_ = ConstructS(1.0, float2x2(float2(1.0, 2.0), float2(3.0, 4.0)));\n";
        let listed = "static S s0_ = { 1.0, 0, float2(1.0, 2.0), float2(3.0, 4.0) };\n";
        assert_eq!(repaired(&format!("{declared}{global}")), format!("{declared}{listed}"));
        let array = "static float2x2 a[1] = Constructarray1_float2x2_(float2x2(float2(1.0, 2.0), float2(3.0, 4.0)));\n";
        assert_eq!(repaired(array), "static float2x2 a[1] = { float2x2(float2(1.0, 2.0), float2(3.0, 4.0)) };\n");
    }

    #[test]
    fn clip_distances_are_vectors() {
        let text = "struct O {\n    float c : SV_ClipDistance;\n};\n    const O_main o_1 = { o.position, o.c };\n";
        assert_eq!(
            with_clip_distances(text, 5),
            "struct O {\n    float4 c : SV_ClipDistance0;\n    float c_1 : SV_ClipDistance1;\n};\n    const O_main o_1 = { \
             o.position, float4(o.c[0], o.c[1], o.c[2], o.c[3]), o.c[4] };\n"
        );
    }
}

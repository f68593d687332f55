//! The mutations of operations: one table for the instructions of SPIR-V (§3.32), one for those of GLSL.std.450.

use super::words::{Instruction, Splice, encoded, op};
use super::{Kind, Mutation};

/// The change of an instruction.
#[derive(Clone, Copy)]
enum Change {
    /// Another instruction with the same operands.
    Code(u16),
    /// The first two operands are swapped.
    Swap,
    /// The second and third operands are swapped.
    SwapLast,
    /// Another instruction, with the first two operands swapped.
    CodeAndSwap(u16),
    /// The result is replaced by the first operand.
    First,
    /// The second operand is replaced by the first.
    Twice,
}

struct Row {
    code: u16,
    name: &'static str,
    becomes: &'static str,
    change: Change,
}

const fn row(code: u16, name: &'static str, becomes: &'static str, change: Change) -> Row {
    Row { code, name, becomes, change }
}

use Change::{Code, CodeAndSwap, First, Swap, SwapLast, Twice};

/// The result type and the result come first; operands start at word 3.
const INSTRUCTIONS: &[Row] = &[
    row(127, "FNegate", "its operand", First),
    row(128, "IAdd", "ISub", Code(130)),
    row(129, "FAdd", "FSub", Code(131)),
    row(130, "ISub", "IAdd", Code(128)),
    row(131, "FSub", "FAdd", Code(129)),
    row(132, "IMul", "IAdd", Code(128)),
    row(133, "FMul", "FAdd", Code(129)),
    row(134, "UDiv", "IMul", Code(132)),
    row(135, "SDiv", "IMul", Code(132)),
    row(136, "FDiv", "FMul", Code(133)),
    row(140, "FRem", "FDiv", Code(136)),
    row(142, "VectorTimesScalar", "the vector", First),
    row(144, "VectorTimesMatrix", "MatrixTimesVector", CodeAndSwap(145)),
    row(145, "MatrixTimesVector", "VectorTimesMatrix", CodeAndSwap(144)),
    row(146, "MatrixTimesMatrix", "the factors swapped", Swap),
    row(148, "Dot", "the square of the first", Twice),
    row(166, "LogicalOr", "LogicalAnd", Code(167)),
    row(167, "LogicalAnd", "LogicalOr", Code(166)),
    row(169, "Select", "the choices swapped", SwapLast),
    row(170, "IEqual", "INotEqual", Code(171)),
    row(171, "INotEqual", "IEqual", Code(170)),
    row(172, "UGreaterThan", "ULessThan", Code(176)),
    row(173, "SGreaterThan", "SLessThan", Code(177)),
    row(174, "UGreaterThanEqual", "ULessThanEqual", Code(178)),
    row(175, "SGreaterThanEqual", "SLessThanEqual", Code(179)),
    row(176, "ULessThan", "UGreaterThan", Code(172)),
    row(177, "SLessThan", "SGreaterThan", Code(173)),
    row(178, "ULessThanEqual", "UGreaterThanEqual", Code(174)),
    row(179, "SLessThanEqual", "SGreaterThanEqual", Code(175)),
    row(180, "FOrdEqual", "FOrdNotEqual", Code(182)),
    row(182, "FOrdNotEqual", "FOrdEqual", Code(180)),
    row(183, "FUnordNotEqual", "FOrdEqual", Code(180)),
    row(184, "FOrdLessThan", "FOrdGreaterThan", Code(186)),
    row(186, "FOrdGreaterThan", "FOrdLessThan", Code(184)),
    row(188, "FOrdLessThanEqual", "FOrdLessThan", Code(184)),
    row(190, "FOrdGreaterThanEqual", "FOrdGreaterThan", Code(186)),
    row(194, "ShiftRightLogical", "ShiftLeftLogical", Code(196)),
    row(195, "ShiftRightArithmetic", "ShiftRightLogical", Code(194)),
    row(196, "ShiftLeftLogical", "ShiftRightLogical", Code(194)),
    row(197, "BitwiseOr", "BitwiseAnd", Code(199)),
    row(198, "BitwiseXor", "BitwiseOr", Code(197)),
    row(199, "BitwiseAnd", "BitwiseOr", Code(197)),
    row(207, "DPdx", "DPdy", Code(208)),
    row(208, "DPdy", "DPdx", Code(207)),
    row(209, "Fwidth", "DPdx", Code(207)),
];

/// The set and the number precede the operands, which start at word 5.
const EXTENDED: &[Row] = &[
    row(1, "Round", "Trunc", Code(3)),
    row(2, "RoundEven", "Trunc", Code(3)),
    row(3, "Trunc", "Floor", Code(8)),
    row(4, "FAbs", "its operand", First),
    row(5, "SAbs", "its operand", First),
    row(6, "FSign", "FAbs", Code(4)),
    row(7, "SSign", "SAbs", Code(5)),
    row(8, "Floor", "Ceil", Code(9)),
    row(9, "Ceil", "Floor", Code(8)),
    row(10, "Fract", "its operand", First),
    row(11, "Radians", "Degrees", Code(12)),
    row(12, "Degrees", "Radians", Code(11)),
    row(13, "Sin", "Cos", Code(14)),
    row(14, "Cos", "Sin", Code(13)),
    row(15, "Tan", "Sin", Code(13)),
    row(16, "Asin", "Acos", Code(17)),
    row(17, "Acos", "Asin", Code(16)),
    row(18, "Atan", "Tanh", Code(21)),
    row(19, "Sinh", "Cosh", Code(20)),
    row(20, "Cosh", "Sinh", Code(19)),
    row(21, "Tanh", "Atan", Code(18)),
    row(22, "Asinh", "Atan", Code(18)),
    row(23, "Acosh", "Asinh", Code(22)),
    row(24, "Atanh", "Atan", Code(18)),
    row(25, "Atan2", "its arguments swapped", Swap),
    row(26, "Pow", "its arguments swapped", Swap),
    row(27, "Exp", "Exp2", Code(29)),
    row(28, "Log", "Log2", Code(30)),
    row(29, "Exp2", "Exp", Code(27)),
    row(30, "Log2", "Log", Code(28)),
    row(31, "Sqrt", "InverseSqrt", Code(32)),
    row(32, "InverseSqrt", "Sqrt", Code(31)),
    row(34, "MatrixInverse", "its operand", First),
    row(37, "FMin", "FMax", Code(40)),
    row(38, "UMin", "UMax", Code(41)),
    row(39, "SMin", "SMax", Code(42)),
    row(40, "FMax", "FMin", Code(37)),
    row(41, "UMax", "UMin", Code(38)),
    row(42, "SMax", "SMin", Code(39)),
    row(43, "FClamp", "its first operand", First),
    row(46, "FMix", "its ends swapped", Swap),
    row(48, "Step", "its arguments swapped", Swap),
    row(49, "SmoothStep", "FClamp", Code(43)),
    row(50, "Fma", "its last operands swapped", SwapLast),
    row(67, "Distance", "0", Twice),
    row(68, "Cross", "its arguments swapped", Swap),
    row(69, "Normalize", "its operand", First),
    row(70, "FaceForward", "its first operand", First),
    row(71, "Reflect", "its arguments swapped", Swap),
    row(72, "Refract", "its arguments swapped", Swap),
];

/// The mutations of one instruction.
pub(super) fn operation(instruction: Instruction<'_>) -> Option<Mutation> {
    let extended = instruction.opcode() == op::EXT_INST;
    let (table, code, operands) = match extended {
        true => (EXTENDED, instruction.word(4) as u16, 5),
        false => (INSTRUCTIONS, instruction.opcode(), 3),
    };
    let row = table.iter().find(|row| row.code == code)?;
    let splice = changed(instruction, row.change, operands, extended)?;
    let name = format!("%{} {} becomes {}", instruction.word(2), row.name, row.becomes);
    Some(Mutation::new(Kind::Operation, name, splice))
}

/// The changed instruction; `None` if nothing would change.
fn changed(instruction: Instruction<'_>, change: Change, operands: usize, extended: bool) -> Option<Splice> {
    let mut words = instruction.words.to_vec();
    match change {
        Code(code) | CodeAndSwap(code) if extended => words[4] = code.into(),
        Code(code) | CodeAndSwap(code) => words[0] = words[0] & !0xffff | u32::from(code),
        First => words = encoded(op::COPY_OBJECT, &[words[1], words[2], words[operands]]),
        Twice => words[operands + 1] = words[operands],
        Swap | SwapLast => {}
    }
    match change {
        Swap | CodeAndSwap(_) => words.swap(operands, operands + 1),
        SwapLast => words.swap(operands + 1, operands + 2),
        Code(_) | First | Twice => {}
    }
    (words != instruction.words).then(|| instruction.replaced(words))
}

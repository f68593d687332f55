//! Values as tests write them: literals of GLSL, and constructors of these.
//!
//! *In:* a word such as `2u` or `vec3(1, 0, 0)`. *Out:* a [`Value`], and its numbers as those of a type. *Holds:* a value that GLSL would not
//! convert to the type is an error (GLSL 1.50 §4.1.10), as is one that the type does not hold; a `bool` is `true` or `false`.

use crate::numeric::Shape;
use glisten_front::hir::Scalar;

/// The most brackets around a value.
const DEEPEST: u32 = 16;

/// A value with its text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Value {
    text: String,
    form: Form,
}

#[derive(Clone, Debug, PartialEq)]
enum Form {
    Literal(Literal),
    /// A constructor of this type, and its arguments.
    Constructor(Shape, Vec<Value>),
}

/// A number of a type.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Literal {
    scalar: Scalar,
    number: f64,
    /// Whether it is written as bits: in base 8 or 16.
    is_bits: bool,
}

impl Value {
    /// The value of a word, within so many brackets.
    fn read(word: &str, depth: u32) -> Result<Self, String> {
        let text = word.to_owned();
        let Some((name, inner)) = word.strip_suffix(')').and_then(|rest| rest.split_once('(')) else {
            let literal = Literal::read(word).ok_or_else(|| format!("`{word}` is not a number"))?;
            return Ok(Self { text, form: Form::Literal(literal) });
        };
        let shape = Shape::named(name.trim()).ok_or_else(|| format!("`{word}` is not a number, and no vector"))?;
        if depth > DEEPEST {
            return Err(format!("`{word}` is in more than {DEEPEST} brackets"));
        }
        let arguments =
            words(inner).into_iter().map(|word| Self::read(word, depth + 1)).collect::<Result<Vec<_>, _>>()?;
        let value = Self { text, form: Form::Constructor(shape, arguments) };
        value.constructed()?;
        Ok(value)
    }

    /// How many numbers it has.
    pub(super) fn size(&self) -> usize {
        match &self.form {
            Form::Literal(_) => 1,
            Form::Constructor(shape, _) => shape.size(),
        }
    }

    /// The numbers of the value as one of this type. A literal is one component, whatever the type has.
    pub(super) fn as_part_of(&self, shape: Shape) -> Result<Vec<f64>, String> {
        match &self.form {
            Form::Literal(literal) => {
                let number = literal.converted(shape.scalar);
                number.map(|number| vec![number]).map_err(|why| format!("`{}` {why}", self.text))
            }
            Form::Constructor(own, _) if *own == shape => self.constructed(),
            Form::Constructor(own, _) => {
                Err(format!("`{}` is a `{}`, not a `{}`", self.text, own.name(), shape.name()))
            }
        }
    }

    /// The numbers that a constructor makes (GLSL 1.50 §5.4), or a literal is.
    fn constructed(&self) -> Result<Vec<f64>, String> {
        let (shape, arguments) = match &self.form {
            Form::Literal(literal) => return Ok(vec![literal.number]),
            Form::Constructor(shape, arguments) => (*shape, arguments),
        };
        let mut numbers = Vec::new();
        for argument in arguments {
            numbers.extend(argument.constructed()?);
        }
        let numbers: Vec<f64> = numbers.into_iter().map(|number| constructed(number, shape.scalar)).collect();
        match (numbers.as_slice(), shape.size()) {
            (all, size) if all.len() == size => Ok(numbers),
            ([one], size) if shape.columns == 1 => Ok(vec![*one; size]),
            ([one], size) => {
                let rows = shape.rows as usize;
                Ok((0..size).map(|index| if index / rows == index % rows { *one } else { 0.0 }).collect())
            }
            (all, size) => {
                Err(format!("`{}` has {} numbers, and a `{}` has {size}", self.text, all.len(), shape.name()))
            }
        }
    }
}

/// All values of a list.
pub(super) fn values(text: &str) -> Result<Vec<Value>, String> {
    words(text).into_iter().map(|word| Value::read(word, 0)).collect()
}

/// The words of a text: between commas and spaces that are not inside of brackets.
fn words(text: &str) -> Vec<&str> {
    let (mut words, mut start, mut depth) = (Vec::new(), 0, 0_u32);
    for (at, letter) in text.char_indices().chain([(text.len(), ',')]) {
        match letter {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ if depth == 0 && (letter == ',' || letter.is_whitespace()) => {
                words.extend(text.get(start..at).map(str::trim).filter(|word| !word.is_empty()));
                start = at + letter.len_utf8();
            }
            _ => {}
        }
    }
    words
}

/// A number that a constructor converts.
fn constructed(number: f64, scalar: Scalar) -> f64 {
    match scalar {
        Scalar::Float => number,
        Scalar::Bool => f64::from(u8::from(number != 0.0)),
        Scalar::Int => f64::from(number.trunc() as i64 as i32),
        Scalar::Uint => f64::from(number.trunc() as i64 as u32),
    }
}

/// The numbers of the values of parameters in order, of which a vector may also be written as its components.
pub(super) fn in_order(values: &[Value], shapes: &[Shape]) -> Result<Vec<f64>, String> {
    let mut numbers = Vec::new();
    let mut values = values.iter();
    for shape in shapes {
        let end = numbers.len() + shape.size();
        while numbers.len() < end {
            let Some(value) = values.next() else { return Err("a number is missing".to_owned()) };
            let part = value.as_part_of(*shape)?;
            if numbers.len() + part.len() > end {
                return Err(format!("`{}` begins within a `{}`", value.text, shape.name()));
            }
            numbers.extend(part);
        }
    }
    Ok(numbers)
}

/// The number of a literal, whatever its type.
pub(super) fn number(word: &str) -> Option<f64> {
    Literal::read(word).filter(|literal| literal.scalar != Scalar::Bool).map(|literal| literal.number)
}

impl Literal {
    fn read(word: &str) -> Option<Self> {
        if let "true" | "false" = word {
            return Some(Self { scalar: Scalar::Bool, number: f64::from(u8::from(word == "true")), is_bits: false });
        }
        let (sign, digits) = match word.strip_prefix('-') {
            Some(digits) => (-1.0, digits),
            None => (1.0, word.strip_prefix('+').unwrap_or(word)),
        };
        let plain = digits.trim_end_matches(['u', 'U']);
        let scalar = if plain.len() < digits.len() { Scalar::Uint } else { Scalar::Int };
        let bits = match plain.strip_prefix("0x").or_else(|| plain.strip_prefix("0X")) {
            Some(digits) => Some((digits, 16)),
            None => plain.strip_prefix('0').filter(|rest| !rest.is_empty()).map(|rest| (rest, 8)),
        };
        if let Some((digits, radix)) = bits
            && let Ok(bits) = u32::from_str_radix(digits, radix)
        {
            return Some(Self { scalar, number: sign * f64::from(bits), is_bits: true });
        }
        let is_whole = !plain.is_empty() && plain.bytes().all(|byte| byte.is_ascii_digit());
        if is_whole {
            // What begins with 0 and is not of base 8 is not an integer.
            let number = plain.parse::<f64>().ok().filter(|_| bits.is_none())?;
            return Some(Self { scalar, number: sign * number, is_bits: false });
        }
        let starts = plain.starts_with(|first: char| first.is_ascii_digit() || first == '.');
        let number =
            digits.trim_end_matches(['f', 'F']).parse::<f64>().ok().filter(|number| starts && number.is_finite())?;
        Some(Self { scalar: Scalar::Float, number: sign * number, is_bits: false })
    }

    /// The number as one of another type, or why that cannot be.
    fn converted(self, to: Scalar) -> Result<f64, String> {
        let Self { scalar: from, number, is_bits } = self;
        let is_whole = from.is_integer();
        match to {
            Scalar::Bool if from == Scalar::Bool => Ok(number),
            Scalar::Bool => Err("is not a `bool`: write `true` or `false`".to_owned()),
            Scalar::Float if from != Scalar::Bool => Ok(number),
            Scalar::Int if from == Scalar::Int => {
                let number = if is_bits { f64::from(number as i64 as i32) } else { number };
                let fits = (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&number);
                if fits { Ok(number) } else { Err("does not fit in an `int`".to_owned()) }
            }
            Scalar::Uint if is_whole => {
                let fits = (0.0..=f64::from(u32::MAX)).contains(&number);
                if fits { Ok(number) } else { Err("does not fit in a `uint`".to_owned()) }
            }
            _ => Err(format!("is not of type `{}`", to.name())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Value, in_order, number};
    use crate::numeric::Shape;

    fn told(word: &str, ty: &str) -> Result<Vec<f64>, String> {
        let shape = Shape::named(ty).expect("it is a type");
        Value::read(word, 0)?.as_part_of(shape)
    }

    #[test]
    fn values_are_those_of_glsl() {
        for (word, ty, numbers) in [
            ("2", "float", &[2.0][..]),
            ("0xff", "int", &[255.0]),
            ("0xFFFFFFFF", "int", &[-1.0]),
            ("0xffffffffu", "uint", &[4_294_967_295.0]),
            ("010", "int", &[8.0]),
            ("-2147483648", "int", &[-2_147_483_648.0]),
            ("1e3f", "float", &[1000.0]),
            ("true", "bool", &[1.0]),
            ("vec3(1)", "vec3", &[1.0; 3]),
            ("mat2(2)", "mat2x2", &[2.0, 0.0, 0.0, 2.0]),
            ("ivec3(ivec2(1.5, 2), true)", "ivec3", &[1.0, 2.0, 1.0]),
        ] {
            assert_eq!(told(word, ty).as_deref(), Ok(numbers), "{word}");
        }
        assert_eq!(
            (number("-0.5"), number("0x10"), number("true"), number("inf")),
            (Some(-0.5), Some(16.0), None, None)
        );
    }

    #[test]
    fn what_glsl_would_not_convert_is_told() {
        for (word, ty, why) in [
            ("1.5", "int", "`1.5` is not of type `int`"),
            ("2u", "int", "`2u` is not of type `int`"),
            ("-1", "uint", "`-1` does not fit in a `uint`"),
            ("2147483648", "int", "`2147483648` does not fit in an `int`"),
            ("true", "float", "`true` is not of type `float`"),
            ("1", "bool", "`1` is not a `bool`: write `true` or `false`"),
            ("vec2(1)", "float", "`vec2(1)` is a `vec2`, not a `float`"),
            ("vec3(1, 2)", "vec3", "`vec3(1, 2)` has 2 numbers, and a `vec3` has 3"),
            ("inf", "float", "`inf` is not a number"),
            ("vek2(1)", "vec2", "`vek2(1)` is not a number, and no vector"),
            ("09", "int", "`09` is not a number"),
        ] {
            assert_eq!(told(word, ty), Err(why.to_owned()));
        }
    }

    #[test]
    fn a_vector_may_be_its_components() {
        let shapes = ["vec2", "float"].map(|name| Shape::named(name).expect("it is a type"));
        let values =
            |words: &[&str]| words.iter().map(|word| Value::read(word, 0).expect("it is read")).collect::<Vec<_>>();
        assert_eq!(in_order(&values(&["1", "2", "3"]), &shapes), Ok(vec![1.0, 2.0, 3.0]));
        assert_eq!(in_order(&values(&["vec2(1, 2)", "3"]), &shapes), Ok(vec![1.0, 2.0, 3.0]));
        assert!(in_order(&values(&["1", "vec2(2, 3)"]), &shapes).is_err());
    }
}

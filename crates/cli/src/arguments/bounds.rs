//! [`Bounds`]: the range of an input of a shader.
//!
//! *In:* a text such as `0..1`, `[0, 1]` or `unit`. *Out:* bounds.

/// The range of an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Bounds {
    /// Each component is a number between these.
    Within([f64; 2]),
    /// A vector of length 1.
    Unit,
}

impl Bounds {
    /// Reads `unit`, `low..high`, `[low, high]`, `low, high`, or one number.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        if text == "unit" {
            return Some(Self::Unit);
        }
        let inner = text.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')).unwrap_or(text);
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
        let parts = inner.split_once("..").or_else(|| inner.split_once(','));
        let [low, high] = match parts {
            Some((low, high)) => [number(low)?, number(high)?],
            None => [number(inner)?; 2],
        };
        (low <= high).then_some(Self::Within([low, high]))
    }
}

#[cfg(test)]
mod tests {
    use super::Bounds;

    #[test]
    fn ranges_are_read_as_people_write_them() {
        assert_eq!(Bounds::parse("unit"), Some(Bounds::Unit));
        for text in ["-1..2.5", "[-1, 2.5]", "-1, 2.5"] {
            assert_eq!(Bounds::parse(text), Some(Bounds::Within([-1.0, 2.5])), "{text}");
        }
        assert_eq!(Bounds::parse("3"), Some(Bounds::Within([3.0, 3.0])));
        for text in ["", "2..1", "a..b", "0..inf"] {
            assert_eq!(Bounds::parse(text), None, "{text}");
        }
    }
}

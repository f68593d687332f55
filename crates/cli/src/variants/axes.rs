//! [`Axis`]: a choice that a variant makes; all variants of a program.
//!
//! *In:* defines with lists of values, lines of keywords as Unity has them, lists of defines as OGRE has them, conditions.
//! *Out:* [`Variant`]s: sets of macros, each once, in the order of the choices, the last axis fastest. *Holds:* there are no
//! more than [`MAX_VARIANTS`].

use std::collections::{BTreeMap, BTreeSet};

/// The largest number of variants of one program.
pub(super) const MAX_VARIANTS: usize = 1_000_000;

/// The macros of a variant.
pub(crate) type Variant = BTreeMap<String, String>;

/// A choice: for each way to decide it, the macros that are then defined.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Axis {
    pub(crate) choices: Vec<Variant>,
}

impl Axis {
    /// The axis of a macro: each of its values, `None` for a variant without it.
    pub(crate) fn of_values(name: &str, values: impl IntoIterator<Item = Option<String>>) -> Self {
        let choice = |value: Option<String>| value.map(|value| (name.to_owned(), value)).into_iter().collect();
        Self { choices: values.into_iter().map(choice).collect() }
    }

    /// The axis of a line of keywords: `multi_compile A B C`, `shader_feature A`, with or without `#pragma`.
    ///
    /// # Errors
    /// The directive is none of Unity's, or a keyword is no name.
    pub(crate) fn of_keywords(line: &str) -> Result<Self, String> {
        let line = line.trim().strip_prefix('#').map_or(line, str::trim_start);
        let mut words = line.split_whitespace().skip_while(|word| *word == "pragma");
        let directive = words.next().unwrap_or_default();
        // The end says for which stages and passes; defined in all of them, the result is the same.
        const ENDS: [&str; 8] = ["local", "vertex", "fragment", "hull", "domain", "geometry", "raytracing", "dynamic"];
        let mut parts: Vec<&str> = directive.split('_').collect();
        while parts.len() > 2 && parts.last().is_some_and(|part| ENDS.contains(part)) {
            parts.pop();
        }
        let mut keywords: Vec<&str> = words.take_while(|word| !word.starts_with("//")).collect();
        match parts.join("_").as_str() {
            "multi_compile" | "dynamic_branch" => {}
            "shader_feature" if keywords.len() == 1 => keywords.insert(0, "_"),
            "shader_feature" => {}
            "multi_compile_fog" => keywords = vec!["_", "FOG_LINEAR", "FOG_EXP", "FOG_EXP2"],
            "multi_compile_instancing" => keywords = vec!["_", "INSTANCING_ON"],
            "skip_variants" => return Err("write `skip = [\"KEYWORD\"]` instead of `skip_variants`".to_owned()),
            _ => return Err(format!("`{directive}` is not known; write `multi_compile A B` or `shader_feature A`")),
        }
        if keywords.is_empty() {
            return Err(format!("`{directive}` names no keyword"));
        }
        let choice = |word: &str| match word.bytes().all(|byte| byte == b'_') {
            true => Ok(Variant::new()),
            false => Ok(Variant::from([define(word)?])),
        };
        Ok(Self { choices: keywords.into_iter().map(choice).collect::<Result<_, String>>()? })
    }

    /// The axis of lists of defines: `A=1,B;C=2` each.
    ///
    /// # Errors
    /// A define without a name.
    pub(crate) fn of_lists(lists: &[String]) -> Result<Self, String> {
        let list = |text: &String| {
            let words = text.split([',', ';']).map(str::trim).filter(|word| !word.is_empty());
            words.map(define).collect::<Result<Variant, String>>()
        };
        Ok(Self { choices: lists.iter().map(list).collect::<Result<_, String>>()? })
    }
}

/// A macro: `NAME` or `NAME=VALUE`.
pub(crate) fn define(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').unwrap_or((text, "1"));
    let starts_well = name.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
    if !starts_well || !name.chars().all(|character| character.is_ascii_alphanumeric() || character == '_') {
        return Err(format!("`{name}` is not a name for a macro"));
    }
    if value.contains(['\n', '\r']) {
        return Err("a macro's value is one line".to_owned());
    }
    Ok((name.to_owned(), value.to_owned()))
}

/// A condition on variants: all of `A` (defined), `A=1` (with this value), `!A` (not defined).
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Condition(Vec<(bool, String, Option<String>)>);

impl Condition {
    /// Reads a condition.
    ///
    /// # Errors
    /// It is empty, or has something that is no name.
    pub(crate) fn new(text: &str) -> Result<Self, String> {
        let term = |word: &str| {
            let (wanted, word) = word.strip_prefix('!').map_or((true, word), |word| (false, word));
            let (name, _) = define(word)?;
            Ok((wanted, name, word.split_once('=').map(|(_, value)| value.to_owned())))
        };
        let terms: Vec<_> = text.split_whitespace().map(term).collect::<Result<_, String>>()?;
        if terms.is_empty() { Err("a condition is empty".to_owned()) } else { Ok(Self(terms)) }
    }

    /// Whether it holds for a variant.
    pub(crate) fn holds(&self, variant: &Variant) -> bool {
        self.0.iter().all(|(wanted, name, value)| {
            let found = variant.get(name).is_some_and(|found| value.as_ref().is_none_or(|value| value == found));
            found == *wanted
        })
    }

    /// Its parts: whether the macro is to be defined, its name, its value if that matters.
    pub(crate) fn terms(&self) -> impl Iterator<Item = (bool, &str, Option<&str>)> {
        self.0.iter().map(|(wanted, name, value)| (*wanted, name.as_str(), value.as_deref()))
    }

    /// The names in it.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|(_, name, _)| name.as_str())
    }
}

/// All variants of the axes: those for which no condition of `skip` holds and, if there are any of `only`, one of them.
///
/// # Errors
/// There are too many.
pub(crate) fn variants(axes: &[Axis], skip: &[Condition], only: &[Condition]) -> Result<Vec<Variant>, String> {
    let count = axes.iter().try_fold(1usize, |count, axis| count.checked_mul(axis.choices.len()));
    let count = count.filter(|count| *count <= MAX_VARIANTS).ok_or_else(|| {
        format!("there are more than {MAX_VARIANTS} variants; fewer values, or `variants` that list them, are needed")
    })?;
    let mut seen = BTreeSet::new();
    let mut all = Vec::new();
    for number in 0..count {
        let mut rest = number;
        let mut chosen = Vec::new();
        for axis in axes.iter().rev() {
            chosen.push(axis.choices.get(rest % axis.choices.len()));
            rest /= axis.choices.len();
        }
        let mut variant = Variant::new();
        for choice in chosen.into_iter().rev().flatten() {
            variant.extend(choice.clone());
        }
        let is_wanted = !skip.iter().any(|condition| condition.holds(&variant))
            && (only.is_empty() || only.iter().any(|condition| condition.holds(&variant)));
        if is_wanted && seen.insert(variant.clone()) {
            all.push(variant);
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::{Axis, Condition, Variant, variants};

    fn shown(variants: &[Variant]) -> Vec<String> {
        let one = |variant: &Variant| {
            variant.iter().map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>().join(" ")
        };
        variants.iter().map(one).collect()
    }

    #[test]
    fn keywords_are_those_of_unity() {
        for (line, choices) in [
            ("multi_compile A B", &["A=1", "B=1"][..]),
            ("#pragma multi_compile _ A // note", &["", "A=1"]),
            ("#  pragma multi_compile_local_fragment __ A B", &["", "A=1", "B=1"]),
            ("shader_feature A", &["", "A=1"]),
            ("shader_feature_local A B", &["A=1", "B=1"]),
            ("multi_compile_fog", &["", "FOG_LINEAR=1", "FOG_EXP=1", "FOG_EXP2=1"]),
            ("multi_compile_instancing", &["", "INSTANCING_ON=1"]),
        ] {
            assert_eq!(shown(&Axis::of_keywords(line).expect(line).choices), choices, "{line}");
        }
        for line in ["", "multi_compile", "multicompile A", "multi_compile 1A", "multi_compile_fwdbase", "pragma"] {
            assert!(Axis::of_keywords(line).is_err(), "{line}");
        }
    }

    #[test]
    fn variants_are_all_choices_once() {
        let axes = [
            Axis::of_keywords("multi_compile _ A").expect("keywords"),
            Axis::of_values("N", [None, Some("1".into()), Some("2".into())]),
            Axis::of_lists(&["X=1,Y;".into(), "X=1;Y=1".into()]).expect("lists"),
        ];
        let all = variants(&axes, &[], &[]).expect("few");
        assert_eq!(shown(&all)[..2], ["X=1 Y=1", "N=1 X=1 Y=1"]);
        assert_eq!(all.len(), 6, "the lists are equal");
        let condition = |text| vec![Condition::new(text).expect(text)];
        let left = |skip: &[Condition], only: &[Condition]| shown(&variants(&axes[..2], skip, only).expect("few"));
        assert_eq!(left(&condition("A N=2"), &[]), ["", "N=1", "N=2", "A=1", "A=1 N=1"]);
        assert_eq!(left(&[], &condition("!A N")), ["N=1", "N=2"]);
        let many: Vec<Axis> = (0..30).map(|_| axes[1].clone()).collect();
        assert!(variants(&many, &[], &[]).is_err());
        assert_eq!(shown(&variants(&[], &[], &[]).expect("one")), [""]);
    }
}

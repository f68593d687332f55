//! Unit tests of the table of operations.

use super::*;
use crate::builtin::functions::all;
use crate::language::SamplerType;

#[test]
fn every_operation_has_prototypes_a_section_and_a_name_of_its_own() {
    for (index, function) in BuiltinFunction::ALL.iter().enumerate() {
        let operation = function.operation();
        assert_eq!(operation.function, *function);
        assert!(operation.prototypes().any(|row| row.name == operation.name), "{}", operation.name);
        assert!(!operation.section().is_empty(), "{}", operation.name);
        assert!(BuiltinFunction::ALL[..index].iter().all(|other| other.name() != operation.name));
    }
}

/// Every function with computed floats has a rule. Exceptions are textures, for which the rules of filters apply, and
/// noise, which is 0.
#[test]
fn every_operation_that_computes_floats_has_a_rule() {
    for function in BuiltinFunction::ALL {
        let operation = function.operation();
        let float =
            operation.prototypes().any(|row| row.ret.spelling().contains("genType") || row.ret.spelling() == "float");
        let without = matches!(operation.class, Class::Texture(_) | Class::Noise(_));
        assert!(operation.rule.is_some() || !float || without, "{} has no rule", operation.name);
    }
    for rule in precision::RULES {
        assert!(!rule.source.is_empty(), "{}", rule.operation);
        assert_eq!(precision::RULES.iter().filter(|other| other.operation == rule.operation).count(), 1);
    }
}

/// The name in a rule is that of the operation that refers to it.
#[test]
fn rules_name_the_operations_that_refer_to_them() {
    for function in BuiltinFunction::ALL {
        if let Some(rule) = function.operation().rule {
            assert!(rule.operation.split(", ").any(|name| name == function.name()), "{}", function.name());
        }
    }
}

#[test]
fn texture_arguments_are_as_many_as_the_prototypes_have() {
    let types = crate::language::Types::basic();
    for row in all() {
        let Class::Texture(form) = row.function.class() else { continue };
        for signature in row.signatures(crate::language::Stage::Fragment) {
            let Some((sampler, rest)) = signature.params().split_first() else { continue };
            let crate::language::Type::Sampler(kind) = types.get(sampler.0) else { continue };
            let arguments = form.arguments(kind);
            let is_optional = |last| matches!(last, Some(&TextureArgument::Bias | &TextureArgument::Component));
            let range = arguments.len() - usize::from(is_optional(arguments.last()))..=arguments.len();
            assert!(range.contains(&rest.len()), "{}: {arguments:?}", signature.describe(row.name, types));
        }
    }
}

#[test]
fn facts_about_samplers() {
    let of = |name: &str| SamplerType::ALL.into_iter().find(|kind| kind.name() == name).expect("a sampler of 1.50");
    assert_eq!(of("sampler1DShadow").reference_component(), 2);
    assert_eq!(of("sampler1DArrayShadow").reference_component(), 2);
    assert_eq!(of("sampler2DArrayShadow").reference_component(), 3);
    assert_eq!(of("samplerCubeShadow").reference_component(), 3);
    assert!(of("sampler2DShadow").is_filtered() && !of("isampler2D").is_filtered() && !of("sampler2DMS").is_filtered());
    assert!(of("usamplerCube").is_integer_cube() && !of("samplerCube").is_integer_cube());
    assert!(!of("sampler2DRect").has_levels() && of("sampler2DRect").is_filtered());
}

#[test]
fn formulas_are_written_as_glsl_writes_them() {
    let text = |rule: &Rule| rule.formula().map(|formula| formula.text(rule.arguments)).unwrap_or_default();
    assert_eq!(text(&precision::SQRT), "1.0 / inversesqrt(x)");
    assert_eq!(text(&precision::POW), "exp2(y * log2(x))");
    assert_eq!(text(&precision::MIX), "x * (1.0 - a) + y * a, or x + (y - x) * a");
    assert_eq!(text(&precision::TANH), "(exp(x) - exp(-x)) * 0.5 / ((exp(x) + exp(-x)) * 0.5)");
    assert_eq!(text(&precision::NORMALIZE), "x * inversesqrt(dot(x, x)), or x / sqrt(dot(x, x))");
    assert_eq!(text(&precision::CROSS), "x[i + 1] * y[i + 2] - y[i + 1] * x[i + 2]");
}

#[test]
fn formulas_are_the_same_only_as_themselves() {
    let formulas: Vec<&Formula> = precision::RULES.iter().filter_map(Rule::formula).collect();
    for (index, one) in formulas.iter().enumerate() {
        for (place, other) in formulas.iter().enumerate() {
            assert_eq!(one.same(other), index == place, "{one:?}");
        }
    }
}

#[test]
fn the_documents_have_every_operation() {
    let page = crate::builtin::operations_markdown();
    for function in BuiltinFunction::ALL {
        assert!(page.contains(&format!("\n| `{}` |", function.name())), "{}", function.name());
    }
    assert!(page.contains("| `dot` | `float dot(genType x, genType y)` | 110 | whole vectors or matrices | 2 m - 1 arithmetic |  | `dot(x, y)` |"), "{page}");
    assert_eq!(crate::builtin::precision_markdown().lines().count(), precision::RULES.len() + 2);
}

//! Tests of the parser, with trees printed as nested lists: operators bind as in §5.1, and declarations are
//! distinguished from expressions.
//! expressions.

use crate::diagnostic::Diagnostics;
use crate::language::Stage;
use crate::source::{Completion, NoIncludes, SourceMap};
use crate::syntax::ast::{Ast, DeclarationKind, ExprId, ExprKind, IncDec, Literal, Stmt, StmtKind, TypeBase, UnaryOp};
use crate::syntax::{ParseOptions, parse};

fn tree(body: &str) -> (Ast, Vec<String>) {
    let mut sources = SourceMap::default();
    let mut diagnostics = Diagnostics::default();
    let text = format!("#version 150\nvoid main() {{ {body} }}");
    let file = sources.add("test.vert", text).expect("room");
    let (defines, completion) = (Vec::new(), Completion::default());
    let options = ParseOptions { stage: Stage::Vertex, defines, strict: false, completion };
    let ast = parse(&mut sources, file, &options, &NoIncludes, &mut diagnostics);
    let messages = diagnostics.iter().map(|diagnostic| diagnostic.message.clone()).collect();
    (ast, messages)
}

fn body(ast: &Ast) -> &[Stmt] {
    match ast.declarations.last().map(|declaration| &declaration.kind) {
        Some(DeclarationKind::Function(_, body)) => body,
        other => panic!("no function: {other:?}"),
    }
}

fn dump(ast: &Ast, id: ExprId) -> String {
    let all = |list: &[ExprId]| list.iter().map(|id| format!(" {}", dump(ast, *id))).collect::<String>();
    match &ast.expr(id).kind {
        ExprKind::Error => "error".to_owned(),
        ExprKind::Literal(Literal::Bool(value)) => value.to_string(),
        ExprKind::Literal(Literal::Int(value)) => value.to_string(),
        ExprKind::Literal(Literal::Uint(value)) => format!("{value}u"),
        ExprKind::Literal(Literal::Float(value)) => format!("{value:?}"),
        ExprKind::Name(name) => ast.name(*name).to_owned(),
        ExprKind::Unary(op, a) => {
            let op = match op {
                UnaryOp::Plus => "+",
                UnaryOp::Minus => "-",
                UnaryOp::Not => "!",
                UnaryOp::BitNot => "~",
            };
            format!("({op} {})", dump(ast, *a))
        }
        ExprKind::IncDec(op, a) => {
            let op = match op {
                IncDec::PreIncrement => "++_",
                IncDec::PreDecrement => "--_",
                IncDec::PostIncrement => "_++",
                IncDec::PostDecrement => "_--",
            };
            format!("({op} {})", dump(ast, *a))
        }
        ExprKind::Binary(op, _, a, b) => format!("({} {} {})", op.spelling(), dump(ast, *a), dump(ast, *b)),
        ExprKind::Assign(op, _, a, b) => {
            format!("({}= {} {})", op.map_or("", |op| op.spelling()), dump(ast, *a), dump(ast, *b))
        }
        ExprKind::Ternary(a, b, c) => format!("(? {} {} {})", dump(ast, *a), dump(ast, *b), dump(ast, *c)),
        ExprKind::Comma(a, b) => format!("(, {} {})", dump(ast, *a), dump(ast, *b)),
        ExprKind::Index(a, b) => format!("([] {}{})", dump(ast, *a), b.map_or(String::new(), |b| all(&[b]))),
        ExprKind::Field(a, name) => format!("(. {} {})", dump(ast, *a), ast.name(*name)),
        ExprKind::Call(name, list) => format!("(call {}{})", ast.name(*name), all(list)),
        ExprKind::Construct(ty, list) => {
            let name = match &ty.base {
                TypeBase::Keyword(symbol) => ast.names.spelling(*symbol),
                TypeBase::Named(name) => ast.name(*name),
                other => panic!("{other:?}"),
            };
            let dims: String = ty
                .array
                .iter()
                .map(|dim| format!("[{}]", dim.size.map_or(String::new(), |id| dump(ast, id))))
                .collect();
            format!("(new {name}{dims}{})", all(list))
        }
        ExprKind::Method(a, name, list) => format!("(method {} {}{})", dump(ast, *a), ast.name(*name), all(list)),
        ExprKind::List(list) => format!("(list{})", all(list)),
    }
}

#[track_caller]
fn check(text: &str, expected: &str) {
    let (ast, messages) = tree(&format!("{text};"));
    assert_eq!(messages, Vec::<String>::new(), "{text}");
    match body(&ast) {
        [Stmt { kind: StmtKind::Expr(id), .. }] => assert_eq!(dump(&ast, *id), expected, "{text}"),
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn operators_bind_by_the_table() {
    check("a + b * c - d", "(- (+ a (* b c)) d)");
    check(
        "a || b ^^ c && d | e ^ f & g == h < i << j + k * -l",
        "(|| a (^^ b (&& c (| d (^ e (& f (== g (< h (<< i (+ j (* k (- l))))))))))))",
    );
    check(
        "a * b + c << d < e == f & g ^ h | i && j ^^ k || l",
        "(|| (^^ (&& (| (^ (& (== (< (<< (+ (* a b) c) d) e) f) g) h) i) j) k) l)",
    );
    check("a - b - c", "(- (- a b) c)");
    check("(a - (b - c))", "(- a (- b c))");
    check("a = b += c", "(= a (+= b c))");
    check("a ? b : c ? d : e", "(? a b (? c d e))");
    check("a ? b, c : d = e", "(? a (, b c) (= d e))");
    check("a = b, c = d", "(, (= a b) (= c d))");
    check("-a++ + ++b", "(+ (- (_++ a)) (++_ b))");
    check("!~+-a", "(! (~ (+ (- a))))");
    check("- -1", "(- (- 1))");
}

#[test]
fn postfix_operators() {
    check("a.b[c].d(e, f)", "(method ([] (. a b) c) d e f)");
    check("f(a, b).x", "(. (call f a b) x)");
    check("f()", "(call f)");
    check("f(void)", "(call f)");
    check("a.length()", "(method a length)");
    check("vec4(1, 2u, 3.0, true)", "(new vec4 1 2u 3.0 true)");
    check("float[2](1.0, 2.0)[0]", "([] (new float[2] 1.0 2.0) 0)");
    check("S[](a)", "(new S[] a)");
    check("S[2](a, b)", "(new S[2] a b)");
    check("a[0][1]", "([] ([] a 0) 1)");
}

#[test]
fn declarations_are_told_from_expressions() {
    let declares = |text: &str| {
        let (ast, messages) = tree(text);
        assert_eq!(messages, Vec::<String>::new(), "{text}");
        match body(&ast) {
            [Stmt { kind: StmtKind::Variables(_), .. }] => true,
            [Stmt { kind: StmtKind::Expr(_), .. }] => false,
            other => panic!("{text}: {other:?}"),
        }
    };
    for text in [
        "S a;",
        "S[2] a;",
        "S a[2] = S[2](x, y);",
        "const S a = S(1);",
        "float[2] a;",
        "struct S { int x; } a;",
        "S[a + b[1]] c;",
    ] {
        assert!(declares(text), "{text}");
    }
    for text in ["S(a);", "S[2](a, b);", "a[2] = b;", "a[b[1]].x++;", "float(a);", "float[2](a, b).length();", "a * b;"]
    {
        assert!(!declares(text), "{text}");
    }
}

#[test]
fn long_else_if_chains_are_flat() {
    let (ast, messages) = tree(&format!("{} a;", "if (a) b; else ".repeat(1000)));
    assert_eq!(messages, Vec::<String>::new());
    assert!(matches!(body(&ast), [Stmt { kind: StmtKind::If { arms, otherwise: Some(_) }, .. }] if arms.len() == 1000));
}

#[test]
fn every_mistake_is_reported_once() {
    let (ast, messages) = tree("float a = ; b = (c; d e f; if (g { h = i; } j = k l; m = n;");
    assert_eq!(
        messages,
        [
            "expected an expression, found `;`",
            "`(` is not closed",
            "expected `;` after the declaration, found `f`",
            "`(` is not closed",
            "expected `;` after the expression, found `l`",
        ]
    );
    assert!(matches!(body(&ast).last(), Some(Stmt { kind: StmtKind::Expr(_), .. })));
}

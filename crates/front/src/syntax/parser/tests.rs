//! Tests of the parser, with trees printed as nested lists: operators bind as in §5.1, and declarations are
//! distinguished from expressions. Broken text: where its error is, and what is kept.

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
        ExprKind::Error(pieces) => format!("(error{})", all(pieces)),
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

/// The messages of a body of several lines with the numbers of their lines, counted from the first one of the body, and its statements.
fn broken(lines: &str) -> (Ast, Vec<(u32, String)>) {
    let mut sources = SourceMap::default();
    let mut diagnostics = Diagnostics::default();
    let text = format!("#version 150\nvoid main() {{\n{lines}\n}}\nvoid after() {{}}\n");
    let file = sources.add("test.vert", text).expect("room");
    let options =
        ParseOptions { stage: Stage::Vertex, defines: Vec::new(), strict: false, completion: Completion::default() };
    let ast = parse(&mut sources, file, &options, &NoIncludes, &mut diagnostics);
    let line = |span| sources.line(span).expect("a place") - 2;
    let found = diagnostics.iter().map(|found| (line(found.primary.span), found.message.clone())).collect();
    (ast, found)
}

#[test]
fn unfinished_lines_end_where_the_next_statement_begins() {
    let unclosed = "`(` is not closed";
    let operand = "expected an expression before the end of the line";
    for (line, message) in [
        ("    vec3 n = normalize(", unclosed),
        ("    x = f(a,", unclosed),
        ("    x = f(a, b", unclosed),
        ("    f(", unclosed),
        ("    x = a[", "`[` is not closed"),
        ("    x = (a + b) * (c", unclosed),
        ("    x = a +", operand),
        ("    x = a + b *", operand),
        ("    x =", operand),
        ("    float x =", operand),
        ("    float x = a ? b :", operand),
        ("    if (", unclosed),
        ("    if (a", unclosed),
        ("    if (a <", operand),
        ("    while (a &&", operand),
        ("    for (int i = 0; i <", operand),
        ("    for (int i = 0;", unclosed),
        ("    a.", "expected the name of a member or a swizzle before the end of the line"),
        ("    x = a.b.", "expected the name of a member or a swizzle before the end of the line"),
        ("    return", "`;` is missing after `return`"),
    ] {
        for next in ["float kept = 1.0;", "for (;;) { float kept; }", "return;", "const float kept = 2.0;"] {
            let (ast, found) = broken(&format!("    before = 1.0;\n{line}\n    {next}\n    last = 2.0;"));
            assert_eq!(found, [(2, message.to_owned())], "{line}\n{next}");
            let Some(DeclarationKind::Function(header, body)) = ast.declarations.first().map(|it| &it.kind) else {
                panic!("{line}: no function");
            };
            assert_eq!(ast.name(header.name), "main");
            let n_known =
                body.iter().filter(|stmt| !matches!(stmt.kind, StmtKind::Error | StmtKind::Broken(_))).count();
            assert!(n_known >= 3, "{line}\n{next}: {body:?}");
            assert_eq!(ast.declarations.len(), 2, "{line}\n{next}: what follows is kept");
        }
    }
}

#[test]
fn assignments_and_calls_on_the_next_line_are_statements() {
    for line in ["    vec3 n = normalize(", "    x = f(a,", "    if (a <", "    f("] {
        for next in ["next = 1.0;", "a.b[2].c += 1.0;", "g(x, y);", "i++;", "S next;"] {
            let (ast, found) = broken(&format!("{line}\n    {next}\n    last = 2.0;"));
            assert_eq!(found.iter().map(|row| row.0).collect::<Vec<_>>(), [1], "{line}\n{next}: {found:?}");
            let Some(DeclarationKind::Function(_, body)) = ast.declarations.first().map(|it| &it.kind) else {
                panic!("{line}: no function");
            };
            assert_eq!(body.len(), 3, "{line}\n{next}: {body:?}");
        }
    }
    // Lines of an expression are no statements, and its mistake is where it is.
    let (_, found) = broken("    x = mix(\n        a,\n        f(b),\n        c d);\n    y = 1.0;");
    assert_eq!(found, [(4, "expected `,`, `)` or an operator, found `d`".to_owned())]);
    let (_, found) = broken("    float a = 1.0,\n    b = 2.0,\n    c = 3.0 4.0;\n    y = 1.0;");
    assert_eq!(found, [(3, "expected `;` after the declaration, found `4.0`".to_owned())]);
}

#[test]
fn broken_statements_keep_what_was_understood() {
    let (ast, _) = broken("    vec3 n = normalize(a.b, c[1] +\n    float x = 1.0;");
    let Some(DeclarationKind::Function(_, body)) = ast.declarations.first().map(|it| &it.kind) else { panic!() };
    let [Stmt { kind: StmtKind::Broken(fragment), .. }, Stmt { kind: StmtKind::Variables(_), .. }] = body.as_slice()
    else {
        panic!("{body:?}")
    };
    assert_eq!(fragment.names.iter().map(|name| ast.name(*name)).collect::<Vec<_>>(), ["n"]);
    assert!(fragment.variables.as_ref().is_some_and(|variables| variables.declarators.len() == 1));
    assert_eq!(fragment.rest.map(|rest| dump(&ast, rest)).as_deref(), Some("(error (. a b) ([] c 1))"));
    let (ast, _) = broken("    for (int i = 0; i < n\n    float x = 1.0;");
    let Some(DeclarationKind::Function(_, body)) = ast.declarations.first().map(|it| &it.kind) else { panic!() };
    assert_eq!(body.len(), 2, "{body:?}");
}

#[test]
fn unfinished_declarations_leave_the_rest() {
    let text = "uniform vec3\nuniform vec3 light;\nvec3 f(vec3 a,\nvoid main() {}\nconst vec3 c = normalize(\nin vec3 d;\n\
                layout(location = 1\nin vec3 e;\nvec3 g(\n    vec3 a,\n    vec3 b) { return a; }\n";
    let mut sources = SourceMap::default();
    let mut diagnostics = Diagnostics::default();
    let file = sources.add("test.vert", format!("#version 150\n{text}")).expect("room");
    let options =
        ParseOptions { stage: Stage::Vertex, defines: Vec::new(), strict: false, completion: Completion::default() };
    let ast = parse(&mut sources, file, &options, &NoIncludes, &mut diagnostics);
    let lines: Vec<u32> = diagnostics.iter().filter_map(|found| sources.line(found.primary.span)).collect();
    assert_eq!(lines, [2, 4, 6, 8], "{:?}", diagnostics.iter().map(|it| &it.message).collect::<Vec<_>>());
    let n_broken = ast.declarations.iter().filter(|it| matches!(it.kind, DeclarationKind::Broken(_))).count();
    assert_eq!((ast.declarations.len(), n_broken), (9, 4));
}

//! Where a lexeme is: in which brackets, at which place of a statement, in the body of which control.
//!
//! *In:* lexeme after lexeme. *Out:* the state before each. *Holds:* a state is small and can be kept, so that each branch of an
//! `#if` begins with the state at the `#if`, and the text after `#endif` with the one at the end of the first branch.

use super::scan::{Kind, Lexeme};

/// No more controls without braces are counted inside of each other.
const MAX_CONTROLS: usize = 64;

/// A bracket that is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Frame {
    /// `{` of statements; whether the statements after a `case` label are reached, and whether it is behind a label itself.
    Code { in_case: bool, labeled: bool },
    /// `{` of statements that stay on one line.
    OneLine,
    /// `{` of the members of a struct or a block.
    Members,
    /// `{` of an initializer list.
    List { hangs: bool },
    /// `(` or `[`; whether a line ends after it, and whether it is the head of a control.
    Paren { hangs: bool, head: bool },
}

/// A control whose body is not complete.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Control {
    If,
    Else,
    Loop,
    /// `do`, before its `while`.
    Do,
}

/// A control, and whether its body is on a line of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Open {
    pub(super) control: Control,
    pub(super) below: bool,
    /// The number of brackets around it.
    depth: usize,
}

/// The state between two lexemes.
#[derive(Clone, Debug, Default)]
pub(super) struct State {
    pub(super) frames: Vec<Frame>,
    pub(super) controls: Vec<Open>,
    /// Whether a statement has begun.
    pub(super) mid: bool,
    /// Whether the statement is a `case` or `default` label.
    pub(super) label: bool,
    /// Whether the head of a control is complete, and its body has not begun.
    pub(super) body_next: bool,
    /// The number of lexemes of the statement so far, without comments.
    count: usize,
    /// Whether the first word may be a macro.
    is_name: bool,
    /// Whether the statement is such a word and one pair of parentheses.
    macro_call: bool,
    /// Whether the statement is the `while` of a `do`.
    ends_do: bool,
    /// Whether a `case` or `default` label has just ended.
    labeled: bool,
}

/// The kind of a `{`.
pub(super) fn brace_frame(before: Option<&Lexeme<'_>>, state: &State) -> Frame {
    let in_list = matches!(state.frames.last(), Some(Frame::List { .. } | Frame::Paren { .. }));
    let labeled = !state.mid && before.is_some_and(|before| before.is(":"));
    let code = Frame::Code { in_case: false, labeled };
    match before {
        Some(before) if in_list || before.is("=") || before.is("return") => Frame::List { hangs: false },
        Some(before) if before.is(")") || before.is("else") || before.is("do") || !state.mid => code,
        Some(before) if before.kind == Kind::Word => Frame::Members,
        Some(before) if before.is("]") => Frame::List { hangs: false },
        _ => code,
    }
}

impl State {
    /// The number of levels of a line that begins with `next`.
    pub(super) fn level(&self, next: &Lexeme<'_>) -> usize {
        let closes = next.is("}") || next.is(")") || next.is("]");
        let mut frames = self.frames.as_slice();
        let mut level = 0;
        if closes && let [rest @ .., last] = frames {
            frames = rest;
            // A closing bracket is where the line of its opening one is.
            level = usize::from(
                self.mid && matches!(last, Frame::Paren { hangs: false, .. } | Frame::List { hangs: false }),
            );
        }
        // The block of a label stands where the label does.
        let is_label = !self.mid && (next.is("case") || next.is("default") || next.is("{") && self.labeled);
        let innermost = frames.iter().rposition(|frame| matches!(frame, Frame::Code { .. } | Frame::Members));
        let mut hanging = 0;
        for (at, frame) in frames.iter().enumerate() {
            level += match frame {
                Frame::Code { in_case, .. } => {
                    let is_label = is_label && innermost == Some(at);
                    let has_block = matches!(self.frames.get(at + 1), Some(Frame::Code { labeled: true, .. }));
                    1 + usize::from(*in_case && !is_label && !has_block)
                }
                Frame::Members => 1,
                Frame::OneLine => 0,
                Frame::List { hangs } | Frame::Paren { hangs, .. } => {
                    hanging += usize::from(*hangs);
                    usize::from(*hangs)
                }
            };
        }
        let settled = usize::from(self.waits_for(next));
        level += self.controls.iter().rev().skip(settled).filter(|open| open.below).count();
        let opens_block = next.is("{") && !self.in_parens();
        let continues = self.mid && !closes && !opens_block && hanging == 0 && !self.body_next;
        level + usize::from(continues)
    }

    /// Goes over a lexeme, which opens `frame` if it is `{`; `hangs` says whether a line ends after it.
    pub(super) fn step(&mut self, lexeme: &Lexeme<'_>, frame: Frame, hangs: bool) {
        if lexeme.is_comment() || lexeme.kind == Kind::Directive {
            return;
        }
        if lexeme.kind == Kind::Other {
            self.end_of_statement();
            return;
        }
        self.count += 1;
        self.labeled = false;
        let starts = !self.mid;
        let body = std::mem::take(&mut self.body_next);
        match lexeme.text {
            "{" => {
                self.frames.push(match frame {
                    Frame::List { .. } => Frame::List { hangs },
                    other => other,
                });
                if !matches!(frame, Frame::List { .. }) {
                    self.mid = false;
                    self.count = 0;
                }
                return;
            }
            "(" | "[" => {
                let head = self.head_next();
                self.frames.push(Frame::Paren { hangs, head });
                self.macro_call = self.is_name && self.count == 2 && lexeme.text == "(";
                self.mid = true;
                return;
            }
            ")" | "]" => {
                if let Some(Frame::Paren { head: true, .. }) = self.frames.pop() {
                    self.body_next = !self.ends_do;
                }
                return;
            }
            "}" => return self.close(),
            ";" if !self.in_parens() => return self.end_of_statement(),
            ":" if self.label && !self.in_parens() => {
                if let Some(Frame::Code { in_case, .. }) = self.frames.last_mut() {
                    *in_case = true;
                }
                self.begin();
                self.labeled = true;
                return;
            }
            _ => {}
        }
        if starts || body {
            self.mid = true;
            self.count = 1;
            self.macro_call = false;
            self.label = matches!(lexeme.text, "case" | "default");
            self.is_name = lexeme.kind == Kind::Word
                && !matches!(lexeme.text, "layout" | "return" | "case" | "struct" | "precision");
            self.word(lexeme.text);
        } else if !matches!(lexeme.text, "," | ".") && !self.in_parens() {
            self.macro_call &= false;
        }
    }

    /// The first word of a statement.
    fn word(&mut self, text: &str) {
        let control = match text {
            "if" => Control::If,
            "else" => Control::Else,
            "for" => Control::Loop,
            "while" if matches!(self.controls.last(), Some(open) if open.control == Control::Do && open.depth == self.frames.len()) =>
            {
                self.controls.pop();
                self.ends_do = true;
                return;
            }
            "while" | "switch" => Control::Loop,
            "do" => Control::Do,
            _ => return,
        };
        if self.controls.len() < MAX_CONTROLS {
            self.controls.push(Open { control, below: false, depth: self.frames.len() });
        }
        self.body_next = matches!(control, Control::Else | Control::Do);
        if self.body_next {
            self.mid = false;
        }
    }

    /// Whether a `(` is the head of the control that has just begun.
    fn head_next(&self) -> bool {
        let is_headed =
            |open: &Open| open.depth == self.frames.len() && matches!(open.control, Control::If | Control::Loop);
        self.count == 2 && (self.ends_do || self.controls.last().is_some_and(is_headed))
    }

    fn in_parens(&self) -> bool {
        matches!(self.frames.last(), Some(Frame::Paren { .. } | Frame::List { .. }))
    }

    /// Whether the statement so far is a macro that stands alone: `NAME` or `NAME(...)`, with nothing around it.
    pub(super) fn is_macro(&self) -> bool {
        self.mid && self.macro_call && !self.in_parens() && !self.body_next
    }

    fn begin(&mut self) {
        (self.mid, self.label, self.body_next, self.macro_call, self.ends_do) = (false, false, false, false, false);
        self.count = 0;
    }

    /// Says that the body of the last control is on a line of its own.
    pub(super) fn body_below(&mut self) {
        if let Some(open) = self.controls.last_mut() {
            open.below = true;
        }
    }

    /// Whether `next` is the `while` of a `do` whose body is complete.
    pub(super) fn waits_for(&self, next: &Lexeme<'_>) -> bool {
        let Some(open) = self.controls.last() else { return false };
        let is_do = open.control == Control::Do && open.depth == self.frames.len();
        is_do && next.is("while") && !self.mid && !self.body_next
    }

    fn close(&mut self) {
        match self.frames.pop() {
            Some(Frame::Members) => self.mid = true,
            Some(Frame::List { .. } | Frame::Paren { .. }) | None => {}
            Some(Frame::Code { .. } | Frame::OneLine) => self.end_of_statement(),
        }
    }

    /// Ends the statement.
    pub(super) fn end_of_statement(&mut self) {
        self.begin();
    }

    /// Completes the controls whose body has ended, before `next` begins.
    pub(super) fn settle(&mut self, next: &Lexeme<'_>) {
        if self.mid || self.body_next {
            return;
        }
        while let Some(open) = self.controls.last() {
            if open.depth < self.frames.len() {
                return;
            }
            let is_same = open.depth == self.frames.len();
            match open.control {
                Control::If if is_same && next.is("else") => {
                    self.controls.pop();
                    return;
                }
                Control::Do if is_same && next.is("while") => return,
                _ => {
                    self.controls.pop();
                }
            }
        }
    }
}

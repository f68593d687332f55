//! Declares variables where the source does, or where they are first used: naga declares all of them at the beginning of
//! the function. Variables that are stored to once become `let`.
//!
//! *Holds:* no evaluation moves, only declarations. A declaration is in a loop only if the source declares the variable
//! there, or if it becomes a store to the whole variable; otherwise the variable would lose its value between iterations.

use super::tree::{BlockId, Body, Expr, NameId, Stmt, StmtKind};

/// How a statement uses a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Use {
    /// It stores all of it, without reading it.
    Store,
    /// It changes it in another way.
    Update,
    /// It passes a pointer to it on.
    Pointer,
    Other,
}

/// A statement that uses a variable.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mention {
    pub(super) block: BlockId,
    pub(super) at: usize,
    pub(super) how: Use,
}

/// A variable that looks for its place.
#[derive(Debug)]
pub(super) struct Local<'m> {
    pub(super) name: NameId,
    pub(super) ty: String,
    pub(super) value: Option<Expr<'m>>,
    /// Its declaration in the source.
    pub(super) span: naga::Span,
    pub(super) mentions: Vec<Mention>,
}

/// A place in front of a statement.
type Place = (BlockId, usize);

/// Declares the variables of a function.
pub(super) fn declare<'m>(body: &mut Body<'m>, locals: Vec<Local<'m>>, is_full: bool) {
    let mut inserted: Vec<(Place, StmtKind<'m>, naga::Span)> = Vec::new();
    for local in locals {
        let span = local.span;
        if !is_full {
            let declaration = StmtKind::Var { name: local.name, ty: local.ty, value: local.value };
            inserted.push(((BlockId(0), 0), declaration, span));
        } else if let Some((place, declaration)) = placed(body, local) {
            inserted.push((place, declaration, span));
        }
    }
    insert(body, inserted);
}

/// Puts statements into their blocks.
fn insert<'m>(body: &mut Body<'m>, mut inserted: Vec<(Place, StmtKind<'m>, naga::Span)>) {
    // Those of one place keep their order.
    inserted.sort_by_key(|((block, at), ..)| (block.0, *at));
    let mut inserted = inserted.into_iter().peekable();
    while let Some(((id, _), ..)) = inserted.peek() {
        let id = *id;
        let Some(block) = body.blocks.get_mut(id.0) else { return };
        let old = std::mem::take(&mut block.statements);
        let mut new = Vec::with_capacity(old.len() + 1);
        for (at, stmt) in old.into_iter().enumerate() {
            while let Some((_, kind, span)) = inserted.next_if(|((block, place), ..)| *block == id && *place <= at) {
                new.push(Stmt::new(kind, span));
            }
            new.push(stmt);
        }
        while let Some((_, kind, span)) = inserted.next_if(|((block, _), ..)| *block == id) {
            new.push(Stmt::new(kind, span));
        }
        block.statements = new;
    }
}

/// Finds the place of a declaration. If it does not become a part of another statement, returns it.
fn placed<'m>(body: &mut Body<'m>, local: Local<'m>) -> Option<(Place, StmtKind<'m>)> {
    let (block, places) = common_block(body, &local.mentions)?;
    let first = places.iter().copied().min()?;
    let writes = |how: Use| matches!(how, Use::Store | Use::Update | Use::Pointer);
    let written = local.mentions.iter().filter(|mention| writes(mention.how)).count();
    let mut at_first = local.mentions.iter().filter(|mention| mention.block == block && mention.at == first);
    let is_stored = at_first.next().is_some_and(|mention| mention.how == Use::Store) && at_first.next().is_none();
    if is_stored && places.iter().filter(|at| **at == first).count() == 1 {
        become_declaration(body, block, first, &local, &places, written == 1);
        return None;
    }
    let (block, first, lifted) = outside_of_loops(body, block, first, local.span);
    let Some(value) = local.value else {
        return Some(((block, first), StmtKind::Var { name: local.name, ty: local.ty, value: None }));
    };
    if written == 0 && value.may_be_let() {
        let first = source_place(body, block, first, local.span);
        return Some(((block, first), StmtKind::Let { name: local.name, value }));
    }
    let declaration = StmtKind::Var { name: local.name, ty: local.ty, value: Some(value) };
    if !lifted && places.iter().all(|at| *at == first) {
        return adopt(body, block, first, declaration).map(|declaration| ((block, first), declaration));
    }
    Some(((block, first), declaration))
}

/// The innermost block around all uses, and the indices of the statements there.
fn common_block(body: &Body<'_>, mentions: &[Mention]) -> Option<(BlockId, Vec<usize>)> {
    let mut places: Vec<Place> =
        mentions.iter().map(|mention| out_of_head(body, (mention.block, mention.at))).collect();
    let mut common = places.first()?.0;
    for (block, _) in &places {
        common = common_ancestor(body, common, *block);
    }
    for place in &mut places {
        while place.0 != common {
            *place = parent(body, place.0)?;
        }
    }
    Some((common, places.into_iter().map(|(_, at)| at).collect()))
}

/// The statement around a block.
fn parent(body: &Body<'_>, block: BlockId) -> Option<Place> {
    body.blocks.get(block.0)?.parent.map(|place| out_of_head(body, place))
}

/// The place of a statement; the head of a loop belongs to the loop's statement.
fn out_of_head(body: &Body<'_>, mut place: Place) -> Place {
    while let Some(block) = body.blocks.get(place.0.0).filter(|block| place.1 < block.in_head)
        && let Some(outer) = block.parent
    {
        place = outer;
    }
    place
}

fn depth(body: &Body<'_>, mut block: BlockId) -> usize {
    let mut depth = 0;
    while let Some((outer, _)) = parent(body, block) {
        (block, depth) = (outer, depth + 1);
    }
    depth
}

fn common_ancestor(body: &Body<'_>, mut one: BlockId, mut other: BlockId) -> BlockId {
    if one == other {
        return one;
    }
    let (mut left, mut right) = (depth(body, one), depth(body, other));
    while one != other {
        let deeper = if left >= right { &mut one } else { &mut other };
        let Some((outer, _)) = parent(body, *deeper) else { return *deeper };
        *deeper = outer;
        if left >= right {
            left = left.saturating_sub(1);
        } else {
            right = right.saturating_sub(1);
        }
    }
    one
}

/// The place outside of all loops that the source does not declare the variable in, and whether it has changed.
fn outside_of_loops(body: &Body<'_>, block: BlockId, at: usize, span: naga::Span) -> (BlockId, usize, bool) {
    let mut place = (block, at);
    let mut inner = block;
    let mut lifted = false;
    while let Some((outer, index)) = parent(body, inner) {
        let repeats = body.blocks.get(inner.0).is_some_and(|block| block.repeats);
        let stmt = body.blocks.get(outer.0).and_then(|block| block.statements.get(index));
        if repeats && !stmt.is_some_and(|stmt| contains(stmt.span, span)) {
            place = (outer, index);
            lifted = true;
        }
        inner = outer;
    }
    (place.0, place.1, lifted)
}

/// Whether a place in the source is inside another.
fn contains(outer: naga::Span, inner: naga::Span) -> bool {
    let (Some(outer), Some(inner)) = (outer.to_range(), inner.to_range()) else { return false };
    outer.start < inner.start && inner.end <= outer.end
}

/// The statement in front of which the source has a declaration, at the latest `first`.
fn source_place(body: &Body<'_>, block: BlockId, first: usize, span: naga::Span) -> usize {
    let Some(own) = span.to_range() else { return first };
    let Some(block) = body.blocks.get(block.0) else { return first };
    let after = |stmt: &Stmt<'_>| stmt.span.to_range().is_some_and(|range| range.start > own.start);
    // Statements in front of it that the source does not have there come first.
    let found = block.statements.iter().take(first).position(after);
    found.unwrap_or(first)
}

/// Makes a store the declaration, or the first part of a `for` that follows and steps the variable.
fn become_declaration(body: &mut Body<'_>, id: BlockId, at: usize, local: &Local<'_>, places: &[usize], once: bool) {
    let Some(stmt) = body.blocks.get_mut(id.0).and_then(|block| block.statements.get_mut(at)) else { return };
    let StmtKind::Assign { value, .. } = &mut stmt.kind else { return };
    let value = std::mem::replace(value, Expr::Leaf("".into()));
    let name = local.name;
    stmt.declared = local.span;
    if once && value.may_be_let() {
        stmt.kind = StmtKind::Let { name, value };
        return;
    }
    let declaration = StmtKind::Var { name, ty: local.ty.clone(), value: Some(value) };
    if places.iter().all(|place| *place == at || *place == at + 1) {
        stmt.kind = StmtKind::Empty;
        let left = adopt(body, id, at + 1, declaration);
        if let (Some(declaration), Some(block)) = (left, body.blocks.get_mut(id.0))
            && let Some(stmt) = block.statements.get_mut(at)
        {
            stmt.kind = declaration;
        }
    } else {
        stmt.kind = declaration;
    }
}

/// Makes a declaration the first part of a `for` that steps the variable. Otherwise returns it.
fn adopt<'m>(body: &mut Body<'m>, block: BlockId, at: usize, declaration: StmtKind<'m>) -> Option<StmtKind<'m>> {
    let stmt = body.blocks.get_mut(block.0).and_then(|block| block.statements.get_mut(at));
    let StmtKind::Var { name, .. } = &declaration else { return Some(declaration) };
    match stmt.map(|stmt| &mut stmt.kind) {
        Some(StmtKind::For { init: init @ None, step: Some(step), .. }) if steps(step, *name) => {
            *init = Some(Box::new(declaration));
            None
        }
        _ => Some(declaration),
    }
}

/// Whether a step changes a variable.
fn steps(step: &StmtKind<'_>, name: NameId) -> bool {
    match step {
        StmtKind::Step { target, .. } | StmtKind::Assign { target, .. } => *target == Expr::Local(name),
        _ => false,
    }
}

/// Returns an output at once that is stored directly in front of the `return`.
pub(super) fn return_at_once(body: &mut Body<'_>) {
    for block in &mut body.blocks {
        let Some([before, last]) = block.statements.last_chunk_mut() else { continue };
        if let (StmtKind::Let { name, value }, StmtKind::Return(Some(returned))) = (&mut before.kind, &mut last.kind)
            && *returned == Expr::Local(*name)
        {
            *returned = std::mem::replace(value, Expr::Leaf("".into()));
            before.kind = StmtKind::Empty;
            last.span = before.span;
        }
    }
}

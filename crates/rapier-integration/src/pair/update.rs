//! The pipeline of a contact query: from the pose of a pair to its manifolds.
//!
//! * The state of the pair comes from the host's workspace ([`state_in`]).
//! * A change of the shapes since the last query drops what no longer holds.
//! * An equal pose leaves the manifolds as they are. Shapes that were apart, and have moved by less
//!   than their distance, have none.
//! * If the candidates of the last descent no longer serve, a descent finds new ones. If there were
//!   none, a lower bound of the distance may replace the descent.
//! * Candidates in reach become contacts ([`PairQuery::contacts`]).
//! * Contacts become manifolds: one each, or a few for all ([`write`](super::write)).

use std::sync::Arc;

use parry3d::query::{ContactManifold, ContactManifoldsWorkspace};
use sbbk_core::traverse::{DescentCounts, SlackPlan};

use super::pose::PairPose;
use super::query::{CandidateMemory, Limits, Pair, PairQuery, PairState, QueryMemory, state_in};
use super::write::Writer;
use crate::mesh::MeshStore;
use crate::stats::QueryOutcome;

/// Number of contacts for which a thread always keeps its memory. Higher: more memory; lower: more
/// allocations.
const LEAST_KEPT: usize = 1024;

/// Brings the manifolds of a pair up to date.
pub(crate) fn update_manifolds<P, M, C>(
    pair: &P,
    store: &Arc<MeshStore>,
    counts: &mut DescentCounts,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) -> QueryOutcome
where
    P: Pair,
    M: Default + 'static,
    C: Default + Copy + 'static,
{
    let new_pair = || store.counters.pairs.raise();
    let state: &mut PairState<P::State, P::Hint> = state_in(workspace, manifolds, new_pair);
    let PairState { shapes, memory } = state;
    memory.apply_change(pair.update(shapes), manifolds);
    let pose = pair.pose();
    if memory.is_unchanged(pose, manifolds.len()) {
        return QueryOutcome::Unchanged;
    }
    if manifolds.is_empty() && memory.is_calm(pose) {
        return QueryOutcome::Apart;
    }
    let mut query = pair.open(shapes);
    memory.begin();
    let mut lent = P::Query::memory().take().unwrap_or_default();
    let outcome = update_contacts(pose, &mut query, memory, counts, &mut lent);
    let plan = query.reduction(&lent.contacts);
    let had_patches = memory.has_patches.replace(plan.is_some());
    let mut writer = Writer::begin(manifolds, had_patches);
    if let Some(plan) = plan {
        writer.write_patches(&mut query, &mut lent, plan);
    } else {
        writer.write_every(&mut query, &mut lent);
    }
    writer.end();
    let count = lent.contacts.len().max(memory.candidates.len());
    if lent.demand.update(count).is_some_and(|limit| limit >= LEAST_KEPT) {
        *lent = QueryMemory { demand: lent.demand, ..QueryMemory::default() };
    }
    P::Query::memory().set(Some(lent));
    memory.end(pose, manifolds.len());
    if manifolds.is_empty() && memory.candidates.is_empty() {
        memory.note_calm(pose, query.moving(), query.reach(), query.calm());
    }
    outcome
}

/// Computes the contacts of a query, in the memory of the thread.
fn update_contacts<Q: PairQuery>(
    pose: &PairPose,
    query: &mut Q,
    memory: &mut CandidateMemory<Q::Hint>,
    counts: &mut DescentCounts,
    QueryMemory { scratch, contacts, .. }: &mut QueryMemory<Q::Scratch, Q::Contact>,
) -> QueryOutcome {
    contacts.clear();
    query.begin(scratch);
    let (moving, reach) = (query.moving(), query.reach());
    let had_none = !memory.slack.is_new() && memory.candidates.is_empty();
    let plan = memory.slack.plan(moving.body, moving.placement(pose), reach, Q::SLACK);
    let (outcome, margin) = match plan {
        SlackPlan::Reuse { margin } => (QueryOutcome::Reused, margin),
        SlackPlan::Descend { margin } => {
            if let Some(clearance) = had_none.then(|| query.clearance(margin)).flatten() {
                memory.slack.note_clear(clearance);
                (QueryOutcome::Apart, clearance)
            } else if margin == reach
                && query.contacts_without_candidates(margin, counts, scratch, contacts)
            {
                memory.candidates.clear();
                return QueryOutcome::Descended;
            } else {
                memory.replace(|found| query.descend(margin, counts, scratch, found));
                (QueryOutcome::Descended, margin)
            }
        }
    };
    let (reach, margin) = (f64::from(reach), f64::from(margin));
    let limits = Limits { reach, margin, travel: memory.slack.travel() };
    query.contacts(&mut memory.candidates, limits, scratch, contacts);
    outcome
}

//! Whole runs: that times, samples and poses are those of the world that was run.

use std::sync::Arc;

use rapier3d::parry::query::DefaultQueryDispatcher;
use sbbk_lab::backend::{Backend, PairKind, Probe, SharedDispatcher, Timed};
use sbbk_lab::metrics::{RunPlan, Sequence, WorldState, run};
use sbbk_lab::scene::{BoxStack, HelicopterBallDrop, MonkeyPile, Scene};

const PLAN: RunPlan =
    RunPlan { warm_up: 5, steps: 35, sample_every: 4, sample_size: 20, query_stride: 1 };

/// Would catch timers that are never started (Rapier's `profiler` feature is off), sampled steps
/// that are timed, a backend that is not installed, and a judge that does not see what the world
/// sees: SBBK's own contacts are exact, in a run as well as asked afresh.
#[test]
fn every_backend_runs_and_is_timed_and_judged() {
    let pile = MonkeyPile { contact_recycling: false, ..MonkeyPile::with_heads(20) };
    let drop: &dyn Scene = &HelicopterBallDrop::default();
    let runs = Backend::ALL.map(|backend| (drop, backend, PLAN.steps));
    for (scene, backend, steps) in [&runs[..], &[(&pile, Backend::Sbbk, 65)]].concat() {
        let name = format!("{} on {backend}", scene.name());
        let run = run(scene, backend, RunPlan { steps, ..PLAN });
        let sampled: Vec<usize> = run.samples.iter().map(|sample| sample.step).collect();
        assert_eq!(sampled, (8..=PLAN.warm_up + steps).step_by(4).collect::<Vec<_>>(), "{name}");
        assert_eq!(run.times.len(), steps - sampled.len());
        assert!(run.mean(|times| times.mesh_mesh_calls as f64) > 0.0, "{name}");
        for times in &run.times {
            assert!(times.broad_phase > 0.0 && times.narrow_phase > 0.0 && times.solver > 0.0);
            assert!(
                times.collision_detection() < times.step && times.mesh_mesh <= times.narrow_phase
            );
        }
        assert!(run.frames_per_second() > 0.0);
        for errors in [run.total(|sample| sample.fresh), run.total(|sample| sample.updated)] {
            assert!(errors.true_pairs > 0, "{name} met nothing");
            assert!(errors.wrong() == 0 || backend != Backend::Sbbk, "{name}: {errors:?}");
        }
    }
}

/// Would catch poses of the wrong step, pairs asked twice or left out, and pairs with the floor.
#[test]
fn captured_pairs_are_asked_once_fresh_and_once_steady() {
    let mut built = MonkeyPile::with_heads(20).build();
    (0..50).for_each(|_| built.world.step());
    let floor = built.world.colliders.iter().next().map(|(handle, _)| handle).unwrap();
    let pairs = || built.world.contact_pairs();
    let heads = pairs().filter(|pair| pair.collider1 != floor && pair.collider2 != floor).count();
    assert!(heads > 10 && heads < pairs().count(), "heads lie on heads and on the floor");
    let captured = Sequence::captured(&mut built.world, |world| world.step());
    assert_eq!(captured.len(), heads);
    let moved = |pair: &&Sequence| pair.poses.len() == 2 && pair.poses[0] != pair.poses[1];
    assert!(captured.iter().filter(moved).count() > heads / 2, "a step moves most pairs");

    let probe = Probe::default();
    let timed: SharedDispatcher =
        Arc::new(Timed::new(Arc::new(DefaultQueryDispatcher), probe.clone()));
    captured.iter().for_each(|pair| pair.walk(&timed, |_, _| ()));
    assert_eq!(probe.tally(PairKind::MeshMesh).calls, 2 * heads as u64);
}

/// Would catch heights or energies of the wrong bodies: heads that fall freely keep their energy,
/// and fall by half of g t squared.
#[test]
fn a_free_fall_keeps_its_energy() {
    let mut built = MonkeyPile::with_heads(10).build();
    built.world.step();
    let first = WorldState::of(&built.world, &built.watched);
    (0..14).for_each(|_| built.world.step());
    let last = WorldState::of(&built.world, &built.watched);
    let fallen = first.mean_height - last.mean_height;
    let [early, late] = [1.0, 15.0].map(|steps: f64| 0.5 * 9.81 * (steps / 60.0).powi(2));
    assert!((fallen - (late - early)).abs() < 0.1 * fallen, "fell {fallen}");
    assert!((last.energy / first.energy - 1.0).abs() < 0.01);
    assert_eq!((last.point_count, last.max_penetration), (0, 0.0));
}

/// Would catch penetration with the wrong sign, and manifolds counted by collider: boxes at rest
/// touch each their neighbours, and hardly sink into them.
#[test]
fn a_stack_touches_and_stands() {
    let mut built = BoxStack::default().build();
    (0..120).for_each(|_| built.world.step());
    let state = WorldState::of(&built.world, &built.watched);
    assert_eq!(state.touching_pair_count, 10);
    assert!(state.contact_manifold_count >= 10 && state.point_count >= 30);
    assert!(state.max_penetration < 0.02 && state.mean_penetration <= state.max_penetration);
    assert!((state.mean_height - 5.0).abs() < 0.05, "{}", state.mean_height);
}

//! What the broad phase refuses, and that refusing changes nothing.

use glamx::Vec3;
use sbbk_core::broad_phase::{
    Bounds, BoundsError, BroadPhase, InsertError, MarginError, StaleHandle, UpdateError,
};

const UNIT: Bounds = Bounds { centre: Vec3::ZERO, radius: 1.0, min: Vec3::NEG_ONE, max: Vec3::ONE };

/// Invalid bounds, what they are refused for, and a number that the message must show.
fn invalid_bounds() -> Vec<(Bounds, BoundsError, &'static str)> {
    let mut cases = Vec::new();
    for radius in [-0.5, f32::NEG_INFINITY, f32::INFINITY] {
        let bounds = Bounds { radius, ..UNIT };
        let shown = if radius == -0.5 { "-0.5" } else { "inf" };
        cases.push((bounds, BoundsError::Radius { radius }, shown));
    }
    for axis in 0..3 {
        for value in [f32::INFINITY, f32::NEG_INFINITY] {
            let mut bad = Vec3::splat(0.25);
            bad[axis] = value;
            let centre = Bounds { centre: bad, ..UNIT };
            cases.push((centre, BoundsError::Centre { centre: bad }, "inf"));
            for (min, max) in [(bad, UNIT.max), (UNIT.min, bad)] {
                let corner = Bounds { min, max, ..UNIT };
                cases.push((corner, BoundsError::Corner { min, max }, "inf"));
            }
        }
        let mut inverted = UNIT;
        inverted.min[axis] = 1.5;
        let (min, max) = (1.5, 1.0);
        cases.push((inverted, BoundsError::Inverted { axis, min, max }, "1.5"));
    }
    cases
}

/// Catches bad input that comes in, an error without the value or the object, an object that
/// loses its bounds to a refused update, and a refused insertion that takes up an index.
#[test]
fn invalid_bounds_are_refused_with_their_value_and_change_nothing() {
    let mut phase = BroadPhase::new(0.0).unwrap();
    let handles = [(); 2].map(|()| phase.insert(&UNIT).unwrap());
    phase.step(|_| ());
    for (bounds, error, shown) in invalid_bounds() {
        let insertion = phase.insert(&bounds).unwrap_err();
        assert_eq!(insertion, InsertError::Bounds(error));
        assert!(insertion.to_string().contains(shown), "{insertion}");

        let handle = handles[1];
        let update = phase.update(handle, &bounds).unwrap_err();
        assert_eq!(update, UpdateError::Bounds { handle, error });
        let message = update.to_string();
        assert!(message.contains(shown) && message.contains("object 1"), "{message}");
    }
    phase.step(|event| panic!("nothing has changed, yet {event:?}"));
    assert!(phase.pairs().eq([handles]));
    assert_eq!(phase.insert(&UNIT).unwrap().index(), 2);
}

/// Catches NaN that passes because every comparison with it is false.
#[test]
fn nan_is_refused_wherever_it_is() {
    let mut phase = BroadPhase::new(0.0).unwrap();
    let mut refuse = |bounds: Bounds| {
        let message = phase.insert(&bounds).unwrap_err().to_string();
        assert!(message.contains("NaN"), "{message}");
    };
    refuse(Bounds { radius: f32::NAN, ..UNIT });
    for axis in 0..3 {
        let mut bad = Vec3::ZERO;
        bad[axis] = f32::NAN;
        refuse(Bounds { centre: bad, ..UNIT });
        refuse(Bounds { min: bad, ..UNIT });
        refuse(Bounds { max: bad, ..UNIT });
    }
}

/// Catches a margin that would make every pair, or none.
#[test]
fn margin_must_be_finite_and_not_negative() {
    for margin in [-1.0, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(BroadPhase::new(margin).err(), Some(MarginError { margin }));
    }
    let message = BroadPhase::new(f32::NAN).unwrap_err().to_string();
    assert!(message.contains("NaN"), "{message}");
    assert_eq!(BroadPhase::new(0.25).unwrap().margin(), 0.25);
}

/// Catches a handle that names the next object in the same place of the table.
#[test]
fn stale_handles_are_errors_also_when_the_index_is_used_again() {
    let mut phase = BroadPhase::new(0.0).unwrap();
    let first = phase.insert(&UNIT).unwrap();
    phase.remove(first).unwrap();
    phase.step(|_| ());
    let second = phase.insert(&UNIT).unwrap();
    assert_eq!((second.index(), second.generation()), (first.index(), first.generation() + 1));

    let stale = StaleHandle(first);
    assert_eq!(phase.update(first, &UNIT), Err(UpdateError::Stale(stale)));
    assert_eq!(phase.remove(first), Err(stale));
    assert!(!phase.contains(first) && phase.contains(second));
    assert!(stale.to_string().contains("object 0 (generation 0)"), "{stale}");
}

/// Catches an index out of range where a handle comes from a larger broad phase.
#[test]
fn handle_of_another_broad_phase_is_an_error() {
    let mut larger = BroadPhase::new(0.0).unwrap();
    let foreign = [(); 3].map(|()| larger.insert(&UNIT).unwrap())[2];
    let mut phase = BroadPhase::new(0.0).unwrap();
    phase.insert(&UNIT).unwrap();
    assert_eq!(phase.remove(foreign), Err(StaleHandle(foreign)));
}

//! Choices that are shown by their names in arguments.

/// Implements `Display` for types with `ValueEnum`.
macro_rules! shown_by_name {
    ($($choice:ty),*) => {$(
        impl std::fmt::Display for $choice {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                let name = clap::ValueEnum::to_possible_value(self).expect("none is hidden");
                f.pad(name.get_name())
            }
        }
    )*};
}

shown_by_name!(
    crate::backend::Backend,
    crate::study::hard::Column,
    crate::study::hard::Group,
    crate::study::hard::random::Family
);

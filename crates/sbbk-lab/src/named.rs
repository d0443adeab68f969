//! Enums whose variants have names for tables.

/// An enum with `Display`, which shows the names, and `ALL`.
macro_rules! named {
    ($(#[$about:meta])* $visibility:vis enum $name:ident {
        $($(#[$about_variant:meta])* $variant:ident = $shown:literal,)*
    }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        $visibility enum $name {
            $($(#[$about_variant])* $variant,)*
        }

        impl $name {
            /// All of them.
            #[allow(dead_code, reason = "not all are gone through")]
            pub const ALL: [Self; [$($shown),*].len()] = [$(Self::$variant),*];
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(match self {
                    $(Self::$variant => $shown,)*
                })
            }
        }
    };
}

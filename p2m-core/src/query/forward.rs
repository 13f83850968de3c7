//! Macros for collectors that wrap another collector: delegation of trait methods to a field.

/// Implements trait methods by delegation to the methods of the same name on the field `$field`.
///
/// The attributes before `fn` apply to every method. A receiver is written `self: &Self` or `self: &mut Self`.
macro_rules! forward_methods {
    (@each $field:ident, $attributes:tt, ) => {};
    (@each $field:ident, [$(#[$attribute:meta])*],
        fn $name:ident($this:ident: $receiver:ty $(, $argument:ident: $type:ty)*) $(-> $result:ty)?; $($rest:tt)*
    ) => {
        $(#[$attribute])*
        fn $name($this: $receiver $(, $argument: $type)*) $(-> $result)? {
            $this.$field.$name($($argument),*)
        }
        forward_methods!(@each $field, [$(#[$attribute])*], $($rest)*);
    };
    ($field:ident, [$(#[$attribute:meta])*], { $($methods:tt)* }) => {
        forward_methods!(@each $field, [$(#[$attribute])*], $($methods)*);
    };
}

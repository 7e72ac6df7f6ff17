// Light is worked out in quads: pixels of one surface that are drawn together share what they look up.
#define QUADS

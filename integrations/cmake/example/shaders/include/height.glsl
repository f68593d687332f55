// The height of a wave.
#ifndef HEIGHT
#define HEIGHT 0.5
#endif

float height(vec2 place, float time) {
    return HEIGHT * (sin(place.x + time) + cos(place.y - time));
}

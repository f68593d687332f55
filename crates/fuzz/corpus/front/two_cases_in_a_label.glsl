//# fragment
#version 150
out vec4 color;
int jump(int i) {
    switch (i) {
    case 0:
    case case 1:
        i += 2;
    }
    return i;
}
void main() { color = vec4(jump(1)); }

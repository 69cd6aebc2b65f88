// Occluders: peeled depth layers (SSDO, Ritschel et al. 2009, section 4; Everitt 2001). The first and second depth are
// the front and back of a solid, and so are the third and fourth: a point between them is inside, and blocked.

uniform sampler2D viewZ;
uniform sampler2D layersZ;     // RGBA32F: viewZ of the layers 0 to 3, -infinity where there is none, and off the screen
uniform sampler2D viewNormal;
uniform sampler2D viewNormal1;
uniform sampler2D viewNormal2;
uniform sampler2D viewNormal3;
uniform sampler2D sender;      // RGB radiance that leaves the surfaces of each layer
uniform sampler2D sender1;
uniform sampler2D sender2;
uniform sampler2D sender3;
uniform vec2 texel_size;       // 1 / resolution
uniform vec4 pixel_from_ray;

// What blocks: where, in view space, and where its properties are stored.
struct Occluder {
    vec3 viewPos;
    vec2 uv;
    int layer;
};

// Where a solid ends that begins at `frontZ`; one without a back is taken to be `thickness` deep.
float backOf(float frontZ, float backZ, float thickness) {
    return isBackground(backZ) ? frontZ - thickness : backZ;
}

// Is the view-space point `samplePos` blocked, and by what? The occluder is the nearer side of the solid that it is in.
bool isBlocked(vec3 samplePos, float thickness, out Occluder occluder) {
    occluder.uv = pixelAt(samplePos, pixel_from_ray) * texel_size;
    vec4 z = texture(layersZ, occluder.uv);
    bool inSecond = z.z > samplePos.z;
    vec2 solid = inSecond ? z.zw : z.xy;
    bool nearerFront = isBackground(solid.y) || solid.x - samplePos.z < samplePos.z - solid.y;
    occluder.layer = (inSecond ? 2 : 0) + (nearerFront ? 0 : 1);
    occluder.viewPos = samplePos * ((nearerFront ? solid.x : solid.y) / samplePos.z);
    return solid.x > samplePos.z && samplePos.z > backOf(solid.x, solid.y, thickness);
}

// The occluder's unit normal, view space.
vec3 occluderNormal(Occluder occluder) {
    vec4 front = occluder.layer < 2 ? texture(viewNormal, occluder.uv) : texture(viewNormal2, occluder.uv);
    vec4 back = occluder.layer < 2 ? texture(viewNormal1, occluder.uv) : texture(viewNormal3, occluder.uv);
    return (occluder.layer & 1) == 0 ? front.xyz : back.xyz;
}

// The light that leaves the occluder.
vec3 occluderRadiance(Occluder occluder) {
    vec4 front = occluder.layer < 2 ? texture(sender, occluder.uv) : texture(sender2, occluder.uv);
    vec4 back = occluder.layer < 2 ? texture(sender1, occluder.uv) : texture(sender3, occluder.uv);
    return (occluder.layer & 1) == 0 ? front.rgb : back.rgb;
}
